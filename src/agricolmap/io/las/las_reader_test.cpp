#include <gmock/gmock.h>

#include <limits>

#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/las/las_test_support.hpp"

namespace agricolmap::io {
namespace {

using test::LasBytes;
using test::TempDir;
using ::testing::Contains;
using ::testing::HasSubstr;

class LasReader : public ::testing::Test {
 protected:
  Cloud read(const std::string& bytes) { return readCloud(folder_.write("cloud.las", bytes)); }
  void expectRefused(const std::string& bytes, const char* what) {
    test::expectError<InputError>([&] { read(bytes); }, {"cloud.las", what});
  }
  static LasBytes threePoints(int format = 2, int minor = 2) {
    LasBytes file;
    file.format = format;
    file.minor = minor;
    file.add(1000, 2000, 3000, {65535, 257, 0});
    file.add(1001, -2000, 3001, {0, 25700, 51400});
    file.add(0, 0, 0, {514, 0, 65535});
    return file;
  }
  TempDir folder_;
};

TEST_F(LasReader, AllPointFormatsOfAllVersions) {
  for (int format = 0; format < kLasFormats; ++format) {
    for (int minor = 0; minor <= 5; ++minor) {
      SCOPED_TRACE("format " + std::to_string(format) + ", LAS 1." + std::to_string(minor));
      LasBytes file;
      file.format = format;
      file.minor = format >= 6 ? std::max(4, minor) : minor;
      file.extra_bytes = format % 2 == 0 ? 0 : 5;
      file.add(1000, 2000, 3000, {65535, 257, 0});
      file.add(1001, -2000, 3001, {0, 25700, 51400});
      const Cloud cloud = read(file.bytes());
      ASSERT_EQ(cloud.size(), 2U);
      EXPECT_EQ(cloud.origin, Eigen::Vector3d(500001.0, 5400002.0, 103.0));
      EXPECT_LT((cloud.filePoint(1) - Eigen::Vector3d(500001.001, 5399998.0, 103.001)).norm(),
                1e-6);
      EXPECT_TRUE(cloud.warnings.empty());
      ASSERT_EQ(cloud.hasColour(), file.layout().rgb.has_value());
      if (!cloud.hasColour()) continue;
      EXPECT_EQ(cloud.rgb[0], (Rgb{255, 1, 0}));
      EXPECT_EQ(cloud.rgb[1], (Rgb{0, 100, 200}));
    }
  }
}

TEST_F(LasReader, ColoursOf8BitsAreToldFromThoseOf16) {
  LasBytes file;
  file.add(0, 0, 0, {255, 1, 0});
  file.add(1, 1, 1, {12, 200, 3});
  EXPECT_EQ(read(file.bytes()).rgb[1], (Rgb{12, 200, 3}));
  file.add(2, 2, 2, {0, 0, 51400});
  EXPECT_EQ(read(file.bytes()).rgb[2], (Rgb{0, 0, 200}));
}

TEST_F(LasReader, ColoursThatAreAllBlackAreNone) {
  LasBytes file;
  file.add(0, 0, 0);
  file.add(1, 1, 1);
  const Cloud cloud = read(file.bytes());
  EXPECT_FALSE(cloud.hasColour());
  EXPECT_THAT(cloud.warnings, Contains(HasSubstr("black")));
}

TEST_F(LasReader, SaysWhatFieldsThereAre) {
  LasBytes file = threePoints(1);
  file.extra_bytes = 4;
  for (std::string& point : file.points) point.append(4, '\0');
  std::string description(192, '\0');
  description.replace(4, 6, "height");
  file.records.push_back(LasBytes::record("LASF_Spec", 4, description));
  const Cloud cloud = read(file.bytes());
  EXPECT_THAT(cloud.fields, HasSubstr("GPS time, 4 extra bytes (height)"));
  EXPECT_THAT(cloud.fields, ::testing::Not(HasSubstr("red")));
}

TEST_F(LasReader, WithheldPointsAreLeftOutAndCounted) {
  for (const int format : {2, 7}) {
    LasBytes file = threePoints(format, format == 7 ? 4 : 2);
    file.add(5, 5, 5, {1, 2, 3}, true);
    file.add(6, 6, 6, {4, 5, 6});
    const Cloud cloud = read(file.bytes());
    EXPECT_EQ(cloud.size(), 4U);
    EXPECT_EQ(cloud.dropped_points, 1U);
    EXPECT_THAT(cloud.warnings,
                ::testing::ElementsAre(HasSubstr("1 points were left out: marked")));
  }
  LasBytes none;
  none.add(1, 1, 1, {}, true);
  expectRefused(none.bytes(), "1 of its 1 points are marked as withheld");
}

TEST_F(LasReader, ManyPointsKeepTheirOrder) {
  LasBytes file;
  constexpr std::int32_t kPoints = 40000;  // several chunks and blocks
  for (std::int32_t i = 0; i < kPoints; ++i) {
    file.add(i, 0, 0, {static_cast<std::uint16_t>(i), 0, 65535}, i % 7 == 3);
  }
  const Cloud cloud = read(file.bytes());
  std::size_t next = 0;
  for (std::int32_t i = 0; i < kPoints; ++i) {
    if (i % 7 == 3) continue;
    ASSERT_NEAR(cloud.filePoint(next).x(), 500000.0 + 0.001 * i, 1e-5);
    ++next;
  }
  EXPECT_EQ(cloud.size(), next);
}

TEST_F(LasReader, WildPointsAreDroppedAndBoundingBoxesNotBelieved) {
  LasBytes file = threePoints();
  file.add(std::numeric_limits<std::int32_t>::max(), 0, 0);  // 2147 km off
  std::string bytes = file.bytes();
  for (std::size_t i = 0; i < 6; ++i) {
    LasBytes::set(bytes, 179 + 8 * i, std::numeric_limits<double>::quiet_NaN());
  }
  const Cloud cloud = read(bytes);
  EXPECT_EQ(cloud.size(), 3U);
  EXPECT_EQ(cloud.dropped_points, 1U);
}

TEST_F(LasReader, CountsOf64BitsGoBefore32) {
  LasBytes file = threePoints(2, 4);
  std::string bytes = file.bytes();
  LasBytes::set(bytes, 107, std::uint32_t{2});
  const Cloud cloud = read(bytes);
  EXPECT_EQ(cloud.size(), 3U);
  EXPECT_THAT(cloud.warnings, Contains(HasSubstr("announces 2 points and 3 points")));
}

TEST_F(LasReader, RecordsThatAreNotThereAreSaid) {
  LasBytes file = threePoints();
  file.records.push_back(LasBytes::record("someone", 7, "data"));
  std::string bytes = file.bytes();
  LasBytes::set(bytes, 100, std::uint32_t{4000000000});
  const Cloud cloud = read(bytes);
  EXPECT_EQ(cloud.size(), 3U);
  EXPECT_THAT(cloud.warnings, Contains(HasSubstr("4000000000 variable length records, only 1")));

  file = threePoints(7, 4);
  bytes = file.bytes();
  LasBytes::set(bytes, 235, std::uint64_t{1} << 62);
  LasBytes::set(bytes, 243, std::uint32_t{2});
  EXPECT_THAT(read(bytes).warnings, Contains(HasSubstr("2 extended variable length records")));
}

TEST_F(LasReader, HeadersThatCannotBeAreRefused) {
  const std::string good = threePoints().bytes();
  const auto with = [&](std::size_t at, auto value) {
    std::string bytes = good;
    LasBytes::set(bytes, at, value);
    return bytes;
  };
  expectRefused(good.substr(0, 200), "truncated: the header");
  expectRefused(good.substr(0, good.size() - 1), "(2 points)");
  expectRefused(with(24, std::uint8_t{2}), "version 2.2");
  expectRefused(with(25, std::uint8_t{6}), "version 1.6");
  expectRefused(with(94, std::uint16_t{100}), "takes 100 bytes");
  expectRefused(with(25, std::uint8_t{4}), "LAS 1.4 has at least 375");
  expectRefused(with(96, std::uint32_t{200}), "within the header");
  expectRefused(with(96, std::uint32_t{4000000000}), "begin at byte 4000000000");
  expectRefused(with(104, std::uint8_t{11}), "format 11");
  expectRefused(with(105, std::uint16_t{25}), "at least 26");
  expectRefused(with(107, std::uint32_t{0}), "0 points");
  expectRefused(with(107, std::uint32_t{4000000000}), "4000000000 points");
  expectRefused(with(131, 0.0), "x has the scale 0");
  expectRefused(with(147, std::numeric_limits<double>::infinity()), "z has the scale inf");
  expectRefused(with(163, std::numeric_limits<double>::quiet_NaN()), "y has the scale");
}

TEST_F(LasReader, CompressedPointsThatDoNotSayHowAreRefused) {
  std::string bytes = threePoints().bytes();
  bytes[104] = static_cast<char>(bytes[104] | 0x80);
#ifdef AGRICOLMAP_HAS_LASZIP
  expectRefused(bytes, "'laszip encoded' is missing");
#else
  expectRefused(bytes, "liblaszip-dev");
#endif
}

}  // namespace
}  // namespace agricolmap::io
