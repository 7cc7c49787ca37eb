#include "agricolmap/io/cloud/cloud_writer.hpp"

#include "agricolmap/core/random.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
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
  for (const CloudFormat format :
       {CloudFormat::kPly, CloudFormat::kPcd, CloudFormat::kLas, CloudFormat::kLaz}) {
#ifndef AGRICOLMAP_HAS_LASZIP
    if (format == CloudFormat::kLaz) continue;
#endif
    SCOPED_TRACE(endingOf(format));
    const auto path = dir / ("out." + endingOf(format));
    writeCloud(path, cloud, format);
    EXPECT_EQ(formatByContent(test::contentOf(path)), format);
    EXPECT_EQ(formatByEnding(path), format);
    const Cloud back = readCloud(path);
    EXPECT_TRUE(back.warnings.empty());
    EXPECT_EQ(back.rgb, cloud.rgb);
    ASSERT_EQ(back.size(), cloud.size());
    const bool las = format == CloudFormat::kLas || format == CloudFormat::kLaz;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d error = back.filePoint(i) - cloud.filePoint(i);
      ASSERT_LT(error.cwiseAbs().maxCoeff(), las ? 0.000505 : 4e-6);
    }
  }
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
