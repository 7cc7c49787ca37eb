#include <lzf.h>

#include <bit>
#include <vector>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::append;
using test::expectError;
using test::TempDir;

struct PcdParts {
  std::string fields = "x y z rgb";
  std::string size = "4 4 4 4";
  std::string type = "F F F F";
  std::string count = "COUNT 1 1 1 1\n";
  std::string shape = "WIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n";
  std::string data = "ascii";

  std::string text() const {
    return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
           size + "\nTYPE " + type + "\n" + count + shape + "DATA " + data + "\n";
  }
};

Cloud read(const TempDir& dir, const std::string& content) {
  return readCloud(dir.write("cloud.pcd", content));
}

void expectRefused(const std::string& content, std::initializer_list<const char*> parts) {
  const TempDir dir;
  expectError<InputError>([&] { read(dir, content); }, parts);
}

/// Two points with a padding field between; `columns`: field after field.
std::string body(bool columns) {
  std::string out;
  const std::uint32_t colour = 0xFF0A141EU;
  const auto value = [](int point, int axis) {
    return 1.5F * static_cast<float>(3 * point + axis);
  };
  if (columns) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int point = 0; point < 2; ++point) append(out, value(point, axis));
    }
    out += std::string(10, 'p');
    for (int point = 0; point < 2; ++point) append(out, colour + static_cast<std::uint32_t>(point));
    return out;
  }
  for (int point = 0; point < 2; ++point) {
    for (int axis = 0; axis < 3; ++axis) append(out, value(point, axis));
    out += std::string(5, 'p');
    append(out, colour + static_cast<std::uint32_t>(point));
  }
  return out;
}

PcdParts binaryParts(const std::string& encoding) {
  PcdParts parts;
  parts.fields = "x y z _ rgb";
  parts.size = "4 4 4 1 4";
  parts.type = "F F F U F";
  parts.count = "COUNT 1 1 1 5 1\n";
  parts.data = encoding;
  return parts;
}

std::string compressed(const std::string& plain) {
  std::vector<char> buffer(2 * plain.size() + 64);
  const unsigned size = lzf_compress(plain.data(), static_cast<unsigned>(plain.size()),
                                     buffer.data(), static_cast<unsigned>(buffer.size()));
  std::string out;
  append(out, static_cast<std::uint32_t>(size));
  append(out, static_cast<std::uint32_t>(plain.size()));
  return out + std::string(buffer.data(), size);
}

void expectTheTwoPoints(const Cloud& cloud) {
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud.filePoint(1), Eigen::Vector3d(4.5, 6, 7.5));
  EXPECT_EQ(cloud.rgb[0], (Rgb{10, 20, 30}));
  EXPECT_EQ(cloud.rgb[1], (Rgb{10, 20, 31}));
}

TEST(PcdReader, ReadsAllEncodings) {
  const TempDir dir;
  expectTheTwoPoints(read(dir, binaryParts("binary").text() + body(false)));
  expectTheTwoPoints(read(dir, binaryParts("binary_compressed").text() + compressed(body(true))));
  // Packed colours as PCL prints them: the integer, or the float with its bits.
  const float bits = std::bit_cast<float>(0x000A141FU);
  char as_float[32];
  std::snprintf(as_float, sizeof(as_float), "%.9g", static_cast<double>(bits));
  expectTheTwoPoints(
      read(dir, PcdParts{}.text() + "0 1.5 3 4278850590\n4.5 6 7.5 " + as_float + "\n"));
}

TEST(PcdReader, ReadsDoublesSeparateColoursAndNoColours) {
  const TempDir dir;
  PcdParts parts;
  parts.fields = "x y z r g b";
  parts.size = "8 8 8 1 1 1";
  parts.type = "F F F U U U";
  parts.count = "";
  parts.shape = "WIDTH 1\nHEIGHT 1\n";
  parts.data = "binary";
  std::string content = parts.text();
  for (const double v : {500000.125, 5000000.123456789, 12.0}) append(content, v);
  const Cloud cloud = read(dir, content + "abc");
  EXPECT_NEAR(cloud.filePoint(0).y(), 5000000.123456789, 1e-8);
  EXPECT_EQ(cloud.rgb[0], (Rgb{'a', 'b', 'c'}));
  parts.fields = "x y z";
  parts.size = "4 4 4";
  parts.type = "F F F";
  parts.data = "ascii";
  EXPECT_FALSE(read(dir, parts.text() + "1 2 3\n").hasColour());
}

TEST(PcdReader, DropsPointsThatAreNotFinite) {
  const TempDir dir;
  PcdParts parts;
  parts.shape = "WIDTH 1\nHEIGHT 3\nPOINTS 3\n";
  const Cloud cloud = read(dir, parts.text() + "nan nan nan 0\n1 2 3 255\nnan 1 1 0\n");
  EXPECT_EQ(cloud.size(), 1U);
  EXPECT_EQ(cloud.dropped_points, 2U);
  EXPECT_EQ(cloud.rgb[0], (Rgb{0, 0, 255}));
}

TEST(PcdReader, CatchesLyingHeaders) {
  const auto with = [](auto change) {
    PcdParts parts;
    change(parts);
    return parts.text() + "0 0 0 0\n1 1 1 0\n";
  };
  expectRefused(with([](auto& p) { p.shape = "WIDTH 2\nHEIGHT 1\nPOINTS 3\n"; }), {"POINTS is 3"});
  expectRefused(with([](auto& p) { p.shape = "WIDTH 5\nHEIGHT 1\n"; }), {"truncated", "5 points"});
  expectRefused(with([](auto& p) { p.shape = "WIDTH 0\nHEIGHT 1\n"; }), {"empty cloud"});
  expectRefused(with([](auto& p) { p.shape = "WIDTH -2\nHEIGHT 1\n"; }), {"'-2'"});
  expectRefused(with([](auto& p) { p.shape = "WIDTH 9000000000000000000\nHEIGHT 9\n"; }),
                {"absurd"});
  expectRefused(with([](auto& p) { p.shape = ""; }), {"neither POINTS"});
  expectRefused(with([](auto& p) { p.size = "4 4 4"; }), {"different numbers"});
  expectRefused(with([](auto& p) { p.size = "4 4 4 3"; }), {"SIZE 3"});
  expectRefused(with([](auto& p) { p.type = "F F F Q"; }), {"TYPE Q"});
  expectRefused(with([](auto& p) { p.fields = "x y x rgb"; }), {"twice"});
  expectRefused(with([](auto& p) { p.fields = "x y w rgb"; }), {"x, y, z"});
  expectRefused(with([](auto& p) { p.count = "COUNT 1 1 1 99999999999\n"; }), {"values a point"});
  expectRefused(with([](auto& p) { p.data = "zip"; }), {"'zip'"});
  expectRefused("VERSION 0.7\nFIELDS x\n", {"no DATA"});
  expectRefused("VERSION 0.4\nDATA ascii\n", {"version"});
  expectRefused(PcdParts{}.text() + "0 0 0 nan\n0 0 0 0\n", {"point 1", "binary"});
}

TEST(PcdReader, CatchesLyingData) {
  const std::string binary = binaryParts("binary").text() + body(false);
  expectRefused(binary.substr(0, binary.size() - 1), {"truncated", "2 points of 21 bytes"});
  const std::string head = binaryParts("binary_compressed").text();
  const std::string data = compressed(body(true));
  expectRefused(head + "abc", {"truncated"});
  expectRefused(head + data.substr(0, data.size() - 1), {"truncated"});
  std::string wrong_size = data;
  wrong_size[4] = 60;
  expectRefused(head + wrong_size, {"60 bytes"});
  std::string absurd = data;
  absurd[7] = 120;
  expectRefused(head + absurd, {"cannot expand"});
  std::string damaged = data;
  damaged[8] = static_cast<char>(0xFF);  // a back reference before the beginning
  expectRefused(head + damaged, {"damaged"});
  const TempDir dir;
  EXPECT_EQ(read(dir, head + data + "rest").size(), 2U);
}

}  // namespace
}  // namespace agricolmap::io
