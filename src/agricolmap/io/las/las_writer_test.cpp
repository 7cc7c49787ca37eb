#include "agricolmap/io/las/las_writer.hpp"

#include <gmock/gmock.h>

#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/las/las_points.hpp"
#include "agricolmap/io/las/las_test_support.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {
namespace {

using test::LasBytes;
using test::TempDir;

/// Records whose every bit is used, but for those that formats have no meaning for.
std::string randomRecords(const LasLayout& layout, std::size_t count, Random& random) {
  std::string records;
  for (std::size_t i = 0; i < count; ++i) {
    std::string record(layout.length, '\0');
    for (char& c : record) c = static_cast<char>(random.below(256));
    LasBytes::set(record, 0, static_cast<std::int32_t>(i * 10 + random.below(100)));
    if (layout.gps_time)
      LasBytes::set(record, *layout.gps_time, 1e5 + 0.001 * static_cast<double>(i));
    records += record;
  }
  return records;
}

/// All records of a file, one after the other.
std::string recordsOf(const std::filesystem::path& path) {
  const MappedFile file(path);
  const LasHeader header = parseLasHeader(file.bytes(), path.string());
  const auto points = lasPoints(file.bytes(), header, path.string());
  std::string records;
  for (std::size_t chunk = 0; chunk < points->chunks(); ++chunk) {
    EXPECT_EQ(points->firstPoint(chunk), records.size() / header.layout.length);
    points->decode(chunk, LasWanted::kAll, [&](const std::byte* from, std::size_t count) {
      records.append(reinterpret_cast<const char*>(from), count * header.layout.length);
    });
  }
  EXPECT_EQ(records.size(), header.points * header.layout.length);
  return records;
}

class LasWriting : public ::testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
#ifndef AGRICOLMAP_HAS_LASZIP
    if (GetParam()) GTEST_SKIP() << "built without LASzip";
#endif
  }
  std::filesystem::path write(const LasOutline& outline, const std::string& records) {
    LasWriter writer(folder_ / "out.las", outline,
                     GetParam() ? LasWriter::Points::kLaz : LasWriter::Points::kPlain);
    const std::size_t length = outline.layout.length;
    writer.write(reinterpret_cast<const std::byte*>(records.data()), records.size() / length);
    writer.close();
    return folder_ / "out.las";
  }
  TempDir folder_;
};

TEST_P(LasWriting, AllFormatsKeepAllBits) {
  Random random(3);
  for (int format = 0; format < kLasFormats; ++format) {
    for (const std::size_t extra : {0, 7}) {
      SCOPED_TRACE("format " + std::to_string(format));
      LasOutline outline;
      outline.minor = format < 6 ? 2 : 4;
      outline.layout = lasLayout(format);
      outline.layout.length += extra;
      const std::string records = randomRecords(outline.layout, 700, random);
      EXPECT_TRUE(recordsOf(write(outline, records)) == records);
    }
  }
}

TEST_P(LasWriting, ManyChunks) {
  Random random(5);
  for (const int format : {2, 7}) {
    LasOutline outline;
    outline.layout = lasLayout(format);
    const std::string records = randomRecords(outline.layout, 120001, random);
    EXPECT_TRUE(recordsOf(write(outline, records)) == records);
  }
}

TEST_P(LasWriting, HeaderIsRightInTheEnd) {
  LasBytes plain;
  plain.format = 7;
  plain.add(-1000, 20, 5);
  plain.add(500, -30, 7);
  plain.points[0][14] = 0x21;  // the first of two returns
  plain.points[1][14] = 0x22;
  LasOutline outline = lasOutline(true);
  outline.scale = Eigen::Vector3d(0.01, 0.001, 0.1);
  outline.offset = Eigen::Vector3d(500000.0, 5400000.0, 0.0);
  outline.records.push_back({"someone", 7, "small", std::vector<std::byte>(9), false});
  outline.records.push_back({"someone", 8, "large", std::vector<std::byte>(70000), false});
  outline.setCrs("PROJCS[\"somewhere\"]");
  const auto path = write(outline, plain.points[0] + plain.points[1]);

  const MappedFile file(path);
  const LasHeader header = parseLasHeader(file.bytes(), "out.las");
  EXPECT_THAT(header.warnings, ::testing::IsEmpty());
  EXPECT_EQ(header.minor, 4);
  EXPECT_EQ(header.points, 2U);
  EXPECT_EQ(header.flags, 0x10);
  EXPECT_EQ(header.offset, outline.offset);
  EXPECT_EQ(header.scale, outline.scale);
  const auto number = [&](std::size_t at) { return loadLe<double>(&file.bytes()[at]); };
  EXPECT_DOUBLE_EQ(number(179), 500005.0);
  EXPECT_DOUBLE_EQ(number(187), 499990.0);
  EXPECT_DOUBLE_EQ(number(195), 5400000.02);
  EXPECT_DOUBLE_EQ(number(219), 0.5);
  EXPECT_EQ(loadLe<std::uint64_t>(&file.bytes()[255]), 1U);
  EXPECT_EQ(loadLe<std::uint64_t>(&file.bytes()[263]), 1U);
  ASSERT_NE(header.find("someone", 7), nullptr);
  ASSERT_NE(header.find("someone", 8), nullptr);
  EXPECT_TRUE(header.find("someone", 8)->extended);
  EXPECT_EQ(header.find("someone", 8)->data.size(), 70000U);
  ASSERT_NE(header.find("LASF_Projection", 2112), nullptr);

  const LasOutline again = lasOutline(file.bytes(), header);
  EXPECT_EQ(again.records.size(), 3U);  // LASzip's own is none of them
  EXPECT_EQ(again.offset, outline.offset);
}

TEST_P(LasWriting, FullDisksAreErrors) {
  LasOutline outline = lasOutline(false);
  Random random(1);
  const std::string records = randomRecords(outline.layout, 100000, random);
  test::expectError<OutputError>(
      [&] {
        LasWriter writer(std::filesystem::path("/dev/full"), outline,
                         GetParam() ? LasWriter::Points::kLaz : LasWriter::Points::kPlain);
        writer.write(reinterpret_cast<const std::byte*>(records.data()), 100000);
        writer.close();
      },
      {"/dev/full"});
}

INSTANTIATE_TEST_SUITE_P(LasAndLaz, LasWriting, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Laz" : "Las"; });

TEST(LasOutline, CoordinatesThatDoNotFitAreTold) {
  LasOutline outline;
  outline.offset = Eigen::Vector3d(1e6, 0, 0);
  std::array<std::byte, 12> record{};
  EXPECT_TRUE(outline.store({1e6 + 2e6, -2e6, 0.0005}, record.data()));
  EXPECT_EQ(loadLe<std::int32_t>(record.data()), 2000000000);
  EXPECT_EQ(loadLe<std::int32_t>(&record[8]), 1);
  EXPECT_FALSE(outline.store({-2e6, 0, 0}, record.data()));
  EXPECT_FALSE(outline.store({1e6, std::nan(""), 0}, record.data()));
}

}  // namespace
}  // namespace agricolmap::io
