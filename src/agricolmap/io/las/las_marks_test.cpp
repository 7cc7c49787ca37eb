// What LAS has of points beside place and colour, through the streams.
#include "agricolmap/io/las/las_marks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/las/las_test_support.hpp"
#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {
namespace {

using test::LasBytes;
using test::TempDir;

constexpr int kPoints = 40'000;  // more than a chunk
constexpr int kWithheldEvery = 7;

/// A file of point format `format` whose marks follow from the number of the point, which is its x
/// in millimetres.
std::string marked(int format, int minor) {
  LasBytes las;
  las.format = format;
  las.minor = minor;
  las.extra_bytes = 3;
  for (int i = 0; i < kPoints; ++i) {
    las.add(i, 2 * i, 5, {100, 60'000, 7}, i % kWithheldEvery == 3);
    std::string& point = las.points.back();
    LasBytes::set(point, 12, static_cast<std::uint16_t>(3 * i));
    if (las.layout().extended) {
      point[14] = 0x52;  // the second of five
      point[16] = static_cast<char>(i % 200);
      point[17] = 9;
      LasBytes::set(point, 18, static_cast<std::int16_t>(-500));
    } else {
      point[14] = static_cast<char>(2 | 5 << 3);
      point[15] = static_cast<char>((point[15] & 0x80) | i % 12);
      point[16] = -3;  // degrees
      point[17] = 9;
    }
  }
  return las.bytes();
}

/// Looks at all marks of a pass; which points passed.
std::vector<int> expectMarks(const PointStream& stream, bool extended) {
  std::vector<int> numbers;
  passMarked(stream, [&](const PointBatch& batch, std::span<const PointMarks> marks) {
    ASSERT_EQ(marks.size(), batch.size());
    for (std::size_t k = 0; k < batch.size(); ++k) {
      const double x = stream.facts().origin.x() + static_cast<double>(batch.xyz[k].x());
      const int i = static_cast<int>(std::lround(1000.0 * (x - 500'000.0)));
      numbers.push_back(i);
      const PointMarks expected{
          .intensity = static_cast<std::uint16_t>(3 * i),
          .returns = 0x52,
          .flags = 0,
          .classification = static_cast<std::uint8_t>(i % (extended ? 200 : 12)),
          .user = 9,
          .scan_angle = -500};
      ASSERT_EQ(marks[k], expected) << i;
    }
  });
  return numbers;
}

void expectAllMarked(const std::filesystem::path& path, bool extended) {
  SCOPED_TRACE(path.string());
  StreamOptions options;
  options.read.marks = true;
  const auto stream = streamCloud(path, options);
  std::vector<int> expected;
  for (int i = 0; i < kPoints; ++i) {
    if (i % kWithheldEvery != 3) expected.push_back(i);
  }
  for (int pass = 0; pass < 2; ++pass) EXPECT_TRUE(expectMarks(*stream, extended) == expected);
}

TEST(LasMarks, PassWithTheirPointsInEveryFormat) {
  const TempDir dir;
  for (const int format : {0, 1, 3, 6, 7, 8}) {
    const bool extended = format >= 6;
    const auto path =
        dir.write("points_" + std::to_string(format) + ".las", marked(format, extended ? 4 : 2));
    expectAllMarked(path, extended);
    if (!hasLaz()) continue;
    const auto laz = dir / ("points_" + std::to_string(format) + ".laz");
    copyLas(path, laz, CloudFormat::kLaz);
    expectAllMarked(laz, extended);
  }
}

TEST(LasMarks, AreNoneWhereNobodyAskedOrTheFileHasNone) {
  const TempDir dir;
  const auto las = dir.write("points.las", marked(7, 4));
  StreamOptions options;
  options.read.marks = true;
  Cloud cloud;
  cloud.xyz.emplace_back(1.0F, 2.0F, 3.0F);
  writeCloud(dir / "cloud.ply", cloud, CloudFormat::kPly);
  const auto unasked = streamCloud(las), ply = streamCloud(dir / "cloud.ply", options);
  for (const PointStream* stream : {unasked.get(), ply.get()}) {
    passMarked(*stream, [](const PointBatch&, std::span<const PointMarks> marks) {
      EXPECT_TRUE(marks.empty());
    });
  }
}

TEST(LasMarks, AreStoredAsTheyWereTaken) {
  const PointMarks marks{700, 0x31, 0x80, 42, 3, -1000};
  std::string record(30, '\x55');
  auto* const bytes = reinterpret_cast<std::byte*>(record.data());
  storeMarks(marks, bytes);
  EXPECT_EQ(marksOf(bytes, lasLayout(6)), marks);
  EXPECT_EQ(record.substr(0, 12), std::string(12, '\x55'));
  EXPECT_EQ(record.substr(20), std::string(10, '\x55'));
}

}  // namespace
}  // namespace agricolmap::io
