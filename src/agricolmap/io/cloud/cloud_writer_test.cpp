#include "agricolmap/io/cloud/cloud_writer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::io {
namespace {

using test::expectError;
using test::TempDir;

Cloud randomCloud(std::size_t points, const Eigen::Vector3d& origin) {
  Random random(7);
  Cloud cloud;
  cloud.origin = origin;
  for (std::size_t i = 0; i < points; ++i) {
    cloud.xyz.emplace_back(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-1, 1));
    cloud.rgb.push_back({static_cast<std::uint8_t>(random.below(256)),
                         static_cast<std::uint8_t>(random.below(256)),
                         static_cast<std::uint8_t>(random.below(256))});
  }
  return cloud;
}

std::vector<CloudFormat> formats() {
  std::vector<CloudFormat> all{CloudFormat::kPly, CloudFormat::kPcd, CloudFormat::kLas};
#ifdef AGRICOLMAP_HAS_LASZIP
  all.insert(all.end(), {CloudFormat::kLaz, CloudFormat::kCopc});
#endif
  return all;
}

TEST(CloudWriter, RoundTripsUtmCoordinates) {
  const TempDir dir;
  const Cloud cloud = randomCloud(200000, {500000, 5000000, 300});
  writePly(dir / "out.ply", cloud);
  const Cloud back = readCloud(dir / "out.ply");
  ASSERT_EQ(back.size(), cloud.size());
  EXPECT_EQ(back.rgb, cloud.rgb);
  double worst = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    worst = std::max(worst, (back.filePoint(i) - cloud.filePoint(i)).norm());
  }
  EXPECT_LT(worst, 4e-6);  // float spacing at 40 m
}

/// Coordinates to the step of the format, colours exactly; through every format and back.
TEST(CloudWriter, AllFormatsRoundTripInUtm) {
  const TempDir dir;
  Cloud cloud = randomCloud(70000, {500000, 5400000, 300});
  cloud.crs = {"somewhere", "PROJCS[\"somewhere\"]"};
  for (const CloudFormat format : formats()) {
    if (format == CloudFormat::kCopc) continue;  // in another order, and told as LAZ
    SCOPED_TRACE(endingOf(format));
    const auto path = dir / ("out." + endingOf(format));
    writeCloud(path, cloud, format);
    EXPECT_EQ(formatByContent(test::contentOf(path)), format);
    EXPECT_EQ(formatByEnding(path), format);
    const Cloud back = readCloud(path);
    EXPECT_TRUE(back.warnings.empty());
    EXPECT_EQ(back.rgb, cloud.rgb);
    ASSERT_EQ(back.size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d error = back.filePoint(i) - cloud.filePoint(i);
      ASSERT_LT(error.cwiseAbs().maxCoeff(), isLas(format) ? 0.000505 : 4e-6);
    }
  }
}

/// Turned, shifted and bent.
PointMove someMove() {
  const Eigen::Affine3d affine(Eigen::Translation3d(3.0, -2.0, 0.5) *
                               Eigen::AngleAxisd(1e-6, Eigen::Vector3d::UnitZ()));
  return {affine, [](const Eigen::Vector3d& point) {
            return Eigen::Vector3d(0.0, 0.1 * std::sin(point.x()), 0.0);
          }};
}

/// What is written of points that pass by is, byte for byte, what is written of them when they are
/// kept: in every format, on any number of threads.
void expectSameAsKept(const std::filesystem::path& source, const std::vector<CloudFormat>& targets,
                      const std::vector<PointMove>& moves) {
  const TempDir dir;
  const Crs crs{"somewhere", "PROJCS[\"somewhere\"]"};
  Cloud cloud = readCloud(source);
  cloud.crs = crs;
  for (const CloudFormat format : targets) {
    for (const PointMove& move : moves) {
      writeCloud(dir / "kept", cloud, format, move);
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(source.filename().string() + " to " + endingOf(format));
        const ThreadLimit limit(threads);
        const auto points = streamCloud(source, {{}, 0, {}, crs});
        writeCloud(dir / "passing", *points, format, move);
        EXPECT_TRUE(test::contentOf(dir / "passing") == test::contentOf(dir / "kept"));
      }
    }
  }
}

TEST(CloudWriter, PointsThatPassByAreWrittenAsThoseThatAreKept) {
  const TempDir dir;
  Cloud cloud = randomCloud(20000, {500000, 5400000, 300});
  std::string text;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d point = cloud.filePoint(i);
    for (const double value : {point.x(), point.y(), point.z()})
      text += fmt::format("{:.3f} ", value);
    // Colours that a first look at the file takes for those of 8 bit.
    text += fmt::format("{} 3 4\n", i > 19900 ? 60000 : 90);
  }
  const std::vector<PointMove> moves{PointMove(), someMove()};
  expectSameAsKept(dir.write("lines.txt", text), formats(), moves);
  cloud.xyz[7].x() = std::numeric_limits<float>::quiet_NaN();
  cloud.xyz[17000].y() = 3e4F;
  for (const CloudFormat format : formats()) {
    if (isLas(format)) cloud.xyz[7].x() = 0.0F;
    const auto source = dir / ("source." + endingOf(format));
    writeCloud(source, cloud, format);
    expectSameAsKept(source, formats(), moves);
  }
  cloud.rgb.clear();
  writePly(dir / "grey.ply", cloud);
  expectSameAsKept(dir / "grey.ply", formats(), moves);
}

TEST(CloudWriter, SoAreThoseOfSeveralBatches) {
  const TempDir dir;
  Cloud cloud;
  cloud.origin = {500000, 5400000, 300};
  for (std::size_t i = 0; i < PointStream::kBatch + 17001; ++i) {
    const std::size_t row = i / 1000;
    const std::size_t column = i % 1000;
    cloud.xyz.emplace_back(0.01F * static_cast<float>(row), 0.01F * static_cast<float>(column),
                           0.0F);
  }
  writePly(dir / "large.ply", cloud);
  std::vector<CloudFormat> targets{CloudFormat::kPly, CloudFormat::kLas};
  if (formats().back() == CloudFormat::kCopc) targets.push_back(CloudFormat::kCopc);
  expectSameAsKept(dir / "large.ply", targets, {PointMove()});
}

TEST(CloudWriter, FormatsAreKnownByTheirEndings) {
  EXPECT_EQ(formatByEnding("a/b.LAZ"), CloudFormat::kLaz);
  EXPECT_EQ(formatByEnding("b.copc.laz"), CloudFormat::kCopc);
  EXPECT_EQ(formatByEnding("laz"), std::nullopt);
  EXPECT_EQ(formatByEnding("b.e57"), std::nullopt);
  EXPECT_EQ(formatByContent("LASF"), CloudFormat::kLas);
  EXPECT_EQ(formatByContent("nothing"), std::nullopt);
}

TEST(CloudWriter, AppliesTheTransformInDouble) {
  const TempDir dir;
  const Cloud cloud = randomCloud(1000, {500000, 5000000, 300});
  Eigen::Affine3d target_from_file(Eigen::Translation3d(3.0, -2.0, 0.5));
  target_from_file.rotate(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()))
      .scale(Eigen::Vector3d(1.1, 0.9, 1.0));
  writePly(dir / "out.ply", cloud, target_from_file);
  const Cloud back = readCloud(dir / "out.ply");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ASSERT_LT((back.filePoint(i) - target_from_file * cloud.filePoint(i)).norm(), 1e-5);
  }
}

TEST(CloudWriter, WritesColoursWhereThereAreAny) {
  const TempDir dir;
  Cloud grey = randomCloud(100, Eigen::Vector3d::Zero());
  grey.rgb.clear();
  writePly(dir / "out.ply", grey);
  const Cloud back = readCloud(dir / "out.ply");
  EXPECT_EQ(back.size(), 100U);
  EXPECT_FALSE(back.hasColour());
}

TEST(CloudWriter, NoticesFailures) {
  const Cloud cloud = randomCloud(1000, Eigen::Vector3d::Zero());
  expectError<OutputError>([&] { writePly("/dev/full", cloud); }, {"/dev/full", "No space"});
  expectError<OutputError>([&] { writeText("/dev/full", "x"); }, {"No space"});
  expectError<OutputError>([&] { writePly("/proc/none/out.ply", cloud); }, {"cannot be created"});
  const TempDir dir;
  expectError<OutputError>([&] { writePly(dir.path(), cloud); }, {"directory"});
}

}  // namespace
}  // namespace agricolmap::io
