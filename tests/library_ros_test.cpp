// Clouds of robots, by a struct that has the members of ROS's message.
#include <gtest/gtest.h>

#include <agricolmap/error.hpp>
#include <agricolmap/ros.hpp>
#include <algorithm>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

namespace agricolmap {
namespace {

/// As sensor_msgs::msg::PointCloud2.
struct Message {
  std::uint32_t height = 1;
  std::uint32_t width = 0;
  std::vector<PointField> fields;
  bool is_bigendian = false;
  std::uint32_t point_step = 0;
  std::uint32_t row_step = 0;
  std::vector<std::uint8_t> data;
};

template <typename Number>
void put(Message& message, std::size_t at, Number number) {
  std::memcpy(message.data.data() + at, &number, sizeof(number));
}

/// Two rows of two points with a gap behind each row, as a depth camera's driver packs them.
Message ofCamera() {
  Message message{
      2, 2, {{"x", 0, 7, 1}, {"y", 4, 7, 1}, {"z", 8, 7, 1}, {"rgb", 16, 7, 1}}, false, 32, 72, {}};
  message.data.resize(144);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::size_t at = std::size_t{i} / 2 * 72 + std::size_t{i} % 2 * 32;
    put(message, at, static_cast<float>(i) + 0.5F);
    put(message, at + 4, 2.0F * static_cast<float>(i));
    put(message, at + 8, -1.0F);
    put(message, at + 16, 0x00102000U + i);
  }
  return message;
}

std::string errorOf(const Message& message) {
  try {
    readPointCloud2(viewOf(message), "/camera/points");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PointCloud2, OfACameraHasPlacesAndPackedColours) {
  const Cloud cloud = readPointCloud2(viewOf(ofCamera()), "/camera/points");
  ASSERT_EQ(cloud.size(), 4U);
  EXPECT_EQ(cloud.filePoint(3), Eigen::Vector3d(3.5, 6.0, -1.0));
  EXPECT_EQ(cloud.rgb[3], (Rgb{0x10, 0x20, 0x03}));
}

TEST(PointCloud2, WithoutColoursAndWithPointsThatAreNone) {
  Message message = ofCamera();
  message.fields.pop_back();
  put(message, 0, std::numeric_limits<float>::quiet_NaN());
  const Cloud cloud = readPointCloud2(viewOf(message));
  EXPECT_EQ(cloud.size(), 3U);
  EXPECT_EQ(cloud.dropped_points, 1U);
  EXPECT_FALSE(cloud.hasColour());
}

TEST(PointCloud2, OfDoublesAndOtherBytesFirst) {
  Message message{1,
                  1,
                  {{"x", 0, 8, 1},
                   {"y", 8, 8, 1},
                   {"z", 16, 8, 1},
                   {"r", 24, 2, 1},
                   {"g", 25, 2, 1},
                   {"b", 26, 2, 1}},
                  false,
                  27,
                  27,
                  {}};
  message.data.resize(27);
  put(message, 0, 500000.25);
  put(message, 8, 5400000.5);
  put(message, 16, 300.125);
  message.data[24] = 7;
  message.data[26] = 9;
  const Cloud cloud = readPointCloud2(viewOf(message));
  EXPECT_EQ(cloud.filePoint(0), Eigen::Vector3d(500000.25, 5400000.5, 300.125));
  EXPECT_EQ(cloud.rgb[0], (Rgb{7, 0, 9}));

  for (const std::size_t at : {0U, 8U, 16U}) {
    std::reverse(message.data.begin() + static_cast<std::ptrdiff_t>(at),
                 message.data.begin() + static_cast<std::ptrdiff_t>(at) + 8);
  }
  message.is_bigendian = true;
  EXPECT_EQ(readPointCloud2(viewOf(message)).filePoint(0), cloud.filePoint(0));
}

TEST(PointCloud2, WhatCannotBeReadIsSaid) {
  const auto changed = [](const auto& change) {
    Message message = ofCamera();
    change(message);
    return errorOf(message);
  };
  EXPECT_EQ(changed([](Message& m) { m.fields[2].name = "w"; }),
            "/camera/points: has no field z, but x, y, w, rgb");
  EXPECT_NE(changed([](Message& m) { m.fields[0].datatype = 4; }).find("type 4"),
            std::string::npos);
  EXPECT_NE(changed([](Message& m) { m.fields[0].datatype = 8; }).find("different types"),
            std::string::npos);
  EXPECT_NE(changed([](Message& m) { m.fields[3].offset = 30; }).find("field rgb lies at byte 30"),
            std::string::npos);
  EXPECT_NE(changed([](Message& m) {
              m.data.pop_back();
              m.data.resize(100);
            }).find("100 bytes"),
            std::string::npos);
  EXPECT_NE(changed([](Message& m) { m.row_step = 60; }).find("rows of 60"), std::string::npos);
  EXPECT_NE(changed([](Message& m) { m.width = 0; }).find("has no points"), std::string::npos);
  EXPECT_NE(changed([](Message& m) { m.fields[0].offset = 0xFFFFFFFEU; }).find("field x"),
            std::string::npos);
}

}  // namespace
}  // namespace agricolmap
