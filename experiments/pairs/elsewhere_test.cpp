// Pairs that the product's simulator did not make, and strips with a displaced part.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/test_support.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "experiments/pairs/pair_maker.hpp"
#include "experiments/pairs/suite.hpp"

namespace agricolmap::experiments {
namespace {

constexpr Settings kAll[] = {Settings::kDevelop, Settings::kCalibrate, Settings::kFinal};

/// 40 m × 12 m of pixels of 10 cm, each coloured by its column and row; no data in the west.
io::RasterImage mosaic() {
  io::RasterImage image;
  image.name = "mosaic";
  image.colour = Raster<Rgb>(120, 400);
  image.valid = Raster<std::uint8_t>(120, 400, 1);
  for (int r = 0; r < 120; ++r) {
    for (int c = 0; c < 400; ++c) {
      image.colour(r, c) = {static_cast<std::uint8_t>(c % 256), static_cast<std::uint8_t>(r),
                            static_cast<std::uint8_t>(c / 256)};
      if (c < 3) image.valid(r, c) = 0;
    }
  }
  image.place.world_from_pixel =
      Eigen::Translation2d(315760.0, 4900915.0) * Eigen::Scaling(0.1, -0.1);
  return image;
}

Eigen::Vector2i pixelOf(const Rgb& colour) { return {colour.r + 256 * colour.b, colour.g}; }

Case dateCase(const std::string& suite, const std::string& name, Settings settings) {
  for (Case& one : makeSuite(suite, {.settings = settings}).cases) {
    if (one.name == name) return one;
  }
  throw UsageError("no case " + name);
}

TEST(Dates, TruthLaysEachPixelWhereItWasCut) {
  const io::RasterImage image = mosaic();
  const Cloud flat = layFlat(image);
  EXPECT_EQ(flat.size(), 120U * 397U);
  EXPECT_LT((flat.filePoint(0) - Eigen::Vector3d(315760.35, 4900914.95, 0.0)).norm(), 1e-4);
  const Case one = dateCase("dates", "dates-1w-15-22", Settings::kFinal);
  const FlatStrip strip = cutStrip(image, *one.dates, one.optionsFor(7));
  EXPECT_NEAR(static_cast<double>(strip.cloud.size()), 3000.0, 60.0);  // 10 m × 3 m
  double guess2 = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < strip.cloud.size(); ++i) {
    const Eigen::Vector2d pixel = pixelOf(strip.cloud.rgb[i]).cast<double>();
    const Eigen::Vector2d cut =
        *image.place.world_from_pixel * (pixel + Eigen::Vector2d::Constant(0.5)).eval();
    const Eigen::Vector3d laid = strip.geotag.nominal * strip.cloud.filePoint(i);
    EXPECT_LT((laid.head<2>() - cut).norm(), 1e-3);
    EXPECT_NEAR(laid.z(), 0.0, 1e-6);
    const Eigen::Vector3d off = strip.geotag.prior * strip.cloud.filePoint(i) - laid;
    mean += off / static_cast<double>(strip.cloud.size());
    guess2 = std::max(guess2, off.squaredNorm());
  }
  EXPECT_NEAR(mean.norm(), 2.0, 0.05);
  EXPECT_LT(std::sqrt(guess2), 2.0 + 5.3 * 0.22);  // and 6 degrees and 10 %
}

TEST(Dates, StripsOfTheSettingsShareNoPixel) {
  const io::RasterImage image = mosaic();
  std::set<int> columns[3];
  for (int i = 0; i < 3; ++i) {
    const Case one = dateCase("dates", "dates-2w-29-15", kAll[i]);
    for (const int seed : {5001, 5002, 5003, 5004, 5005}) {
      for (const Rgb& colour : cutStrip(image, *one.dates, one.optionsFor(seed)).cloud.rgb) {
        columns[i].insert(pixelOf(colour).x());
      }
    }
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_GT(columns[i].size(), 100U);
    for (const int column : columns[i]) EXPECT_FALSE(columns[(i + 1) % 3].contains(column));
  }
}

TEST(Dates, MirroredStripsAreTheSameWithTheirSidesOrEndsSwapped) {
  const io::RasterImage image = mosaic();
  const Case right = dateCase("dates", "dates-1w-22-15", Settings::kDevelop);
  const FlatStrip strip = cutStrip(image, *right.dates, right.optionsFor(3));
  Eigen::Vector3d at[2][3];  // of the first pixel and the last, in the strip, its mirrored copies
  int number = 1;
  for (const char* name : {"mirrored-sides-1w-22-15", "mirrored-ends-1w-22-15"}) {
    const Case one = dateCase("mirrored", name, Settings::kDevelop);
    EXPECT_TRUE(one.options.mirrored);
    const FlatStrip copy = cutStrip(image, *one.dates, one.optionsFor(3));
    ASSERT_EQ(copy.cloud.rgb, strip.cloud.rgb);
    for (int k = 0; k < 2; ++k) {
      const std::size_t i = k == 0 ? 0 : strip.cloud.size() - 1;
      at[k][0] = strip.geotag.nominal * strip.cloud.filePoint(i);
      at[k][number] = copy.geotag.nominal * copy.cloud.filePoint(i);
    }
    ++number;
  }
  // Turned by half a circle the two copies are one, which is the strip in a mirror.
  const auto distance = [&](int which) { return (at[0][which] - at[1][which]).norm(); };
  EXPECT_NEAR(distance(1), distance(0), 1e-3);
  EXPECT_NEAR(distance(2), distance(0), 1e-3);
  EXPECT_NEAR((at[0][1] + at[0][2] - at[1][1] - at[1][2]).norm(), 0.0, 1e-3);
}

TEST(Dates, NoRoomIsSaid) {
  Case one = dateCase("dates", "dates-1w-15-22", Settings::kFinal);
  one.options.ugv.width = 20.0;
  test::expectError<InputError>([&] { cutStrip(mosaic(), *one.dates, one.optionsFor(1)); },
                                {"mosaic", "10 x 20 m", "ugv.width"});
}

double greenness(const Rgb& rgb) {
  return static_cast<double>(map::excessGreen(rgb, map::ExgKind::kChromatic));
}

/// Cell of 5 cm.
std::pair<long, long> cellOf(const Eigen::Vector3d& at) {
  return {std::lround(at.x() / 0.05), std::lround(at.y() / 0.05)};
}
using Greenness = std::map<std::pair<long, long>, double>;

/// Of Excess Green of the strip's points, laid where the truth says and `aside` of it, with that of
/// the map there.
double correlation(const Pair& pair, const Greenness& fixed, const Eigen::Vector3d& aside) {
  Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();  // of products of 1, the map's and the strip's
  for (std::size_t i = 0; i < pair.moving.size(); ++i) {
    const Eigen::Vector3d at = pair.truth.best_affine * pair.moving.filePoint(i) + aside;
    const auto there = fixed.find(cellOf(at));
    if (there == fixed.end()) continue;
    const Eigen::Vector3d of(1.0, there->second, greenness(pair.moving.rgb[i]));
    sums += of * of.transpose();
  }
  const Eigen::Vector3d mean = sums.col(0) / sums(0, 0);
  const Eigen::Matrix3d covariance = sums / sums(0, 0) - mean * mean.transpose();
  return covariance(1, 2) / std::sqrt(covariance(1, 1) * covariance(2, 2));
}

/// Needs the shared data.
TEST(Dates, FlightsOneWeekApartAgreeWhereTheTruthSays) {
  PairMaker maker(AGRICOLMAP_SHARED_DIR);
  const Case one = dateCase("dates", "dates-1w-15-22", Settings::kDevelop);
  const std::string missing = maker.unavailable(one);
  if (!missing.empty()) GTEST_SKIP() << missing;
  const Pair pair = maker.make(one, 5001);
  EXPECT_TRUE(pair.overlaps);
  EXPECT_NEAR(static_cast<double>(pair.moving.size()), 30.0 / (0.0266 * 0.0266), 1500.0);
  Greenness fixed;
  for (std::size_t i = 0; i < pair.fixed->size(); ++i) {
    fixed[cellOf(pair.fixed->filePoint(i))] = greenness(pair.fixed->rgb[i]);
  }
  const double here = correlation(pair, fixed, Eigen::Vector3d::Zero());
  EXPECT_GT(here, 0.5);
  for (const double aside : {-0.3, 0.3}) {
    EXPECT_LT(correlation(pair, fixed, {aside, 0.0, 0.0}), here - 0.05);
    EXPECT_LT(correlation(pair, fixed, {0.0, aside, 0.0}), here - 0.05);
  }
  const Case mirrored = dateCase("mirrored", "mirrored-ends-1w-15-22", Settings::kDevelop);
  EXPECT_FALSE(maker.make(mirrored, 5001).overlaps);
}

/// Likewise.
TEST(Dates, EachPartOfTheTrialHasRoomForStrips) {
  PairMaker maker(AGRICOLMAP_SHARED_DIR);
  for (const Settings settings : kAll) {
    const Case one = dateCase("dates", "dates-2w-15-29", settings);
    const std::string missing = maker.unavailable(one);
    if (!missing.empty()) GTEST_SKIP() << missing;
    const io::RasterImage image =
        io::readRaster(std::filesystem::path(AGRICOLMAP_SHARED_DIR) / dateFile(one.dates->moving));
    for (int seed = 5001; seed <= 5020; ++seed) {
      EXPECT_GT(cutStrip(image, *one.dates, one.optionsFor(seed)).cloud.size(), 41000U) << seed;
    }
  }
}

TEST(Slips, DisplaceOneEndAndKeepEachPointsTruth) {
  Case straight;
  straight.options = simulate::cropPreset(simulate::Crop::kSugarBeet20m);
  straight.options.field.width = straight.options.field.height = 6.0;
  straight.options.ugv.length = 4.0;
  straight.options.ugv.width = 1.2;
  Case slipped = straight;
  slipped.slip = {.metres = 0.3, .share = 1.0 / 3.0, .along = false};
  EXPECT_NE(slipped.text(), straight.text());
  PairMaker maker("nowhere");
  const Pair before = maker.make(straight, 8);
  const Pair after = maker.make(slipped, 8);
  ASSERT_EQ(after.truth.points, before.truth.points);
  EXPECT_TRUE(after.overlaps);
  std::size_t moved = 0;
  for (std::size_t i = 0; i < before.moving.size(); ++i) {
    if (after.moving.xyz[i] == before.moving.xyz[i]) continue;
    ++moved;
    const Eigen::Vector3d by = before.truth.best_affine.linear() *
                               (after.moving.xyz[i] - before.moving.xyz[i]).cast<double>().eval();
    EXPECT_NEAR(by.norm(), 0.3, 0.01);
  }
  EXPECT_NEAR(static_cast<double>(moved) / static_cast<double>(before.moving.size()), 1.0 / 3.0,
              0.05);
  // What fits the larger part leaves the other as far off as it slipped.
  const evaluate::RegistrationErrors errors =
      evaluate::evaluateTransform(after.truth.best_affine, after.truth, after.moving);
  EXPECT_NEAR(errors.rms_horizontal, 0.3 / std::sqrt(3.0), 0.02);
  EXPECT_LT(errors.rms_to_best_affine, 1e-6);
}

TEST(Slips, HaveAStripEach) {
  for (const Settings settings : kAll) {
    std::set<std::pair<int, int>> strips;
    const std::vector<Case> cases = makeSuite("slips", {.settings = settings}).cases;
    for (const Case& one : cases) {
      strips.emplace(static_cast<int>(one.options.crop), one.stripOf(5001));
    }
    EXPECT_EQ(cases.size(), 100U);
    EXPECT_EQ(strips.size(), cases.size());
  }
}

TEST(OtherGenerator, IsReadAsItWrites) {
  const test::TempDir dir;
  Case one = makeSuite("other-generator", {.settings = Settings::kDevelop}).cases.front();
  PairMaker maker(dir.path());
  EXPECT_NE(maker.unavailable(one).find("scripts/other-generator"), std::string::npos);
  const std::filesystem::path folder = dir / (one.folder + "/1001");
  std::filesystem::create_directories(folder);
  EXPECT_EQ(maker.unavailable(one), "");
  Cloud cloud;
  for (const float x : {0.0F, 4.0F}) {
    for (const float y : {0.0F, 2.0F}) cloud.xyz.emplace_back(x, y, 0.1F * x * y);
  }
  cloud.rgb.assign(4, {40, 90, 30});
  io::writePly(folder / "uav.ply", cloud);
  io::writePly(folder / "ugv.ply", cloud);
  io::writeMatrix(folder / "truth.txt", Eigen::Affine3d(Eigen::Translation3d(5.0, 0.0, 0.0)));
  io::writeMatrix(folder / "best.txt", Eigen::Affine3d(Eigen::Translation3d(5.0, 0.02, 0.0)));
  const Pair pair = maker.make(one, 1001);
  EXPECT_TRUE(pair.guess.isApprox(Eigen::Affine3d::Identity()));
  EXPECT_LT((pair.truth.points.at(3) - Eigen::Vector3d(9.0, 2.0, 0.8)).norm(), 1e-6);
  EXPECT_NEAR(pair.truth.best_affine.translation().y(), 0.02, 1e-12);
  // A seed that was not made is named.
  test::expectError<InputError>([&] { maker.make(one, 1002); }, {"1002"});
}

}  // namespace
}  // namespace agricolmap::experiments
