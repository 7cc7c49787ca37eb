#include "agricolmap/simulate/simulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/simulate/test_support.hpp"

namespace agricolmap::simulate {
namespace {

TEST(Simulate, PresetsAreWithinTheirLimitsAndDistinct) {
  for (const Crop crop : {Crop::kSoybean, Crop::kSugarBeet10m, Crop::kSugarBeet20m,
                          Crop::kWinterWheat, Crop::kMaize}) {
    SimulationOptions options = cropPreset(crop);
    EXPECT_EQ(options.crop, crop);
    EXPECT_NO_THROW(checkOptions(options));
  }
  EXPECT_GT(cropPreset(Crop::kSugarBeet20m).uav.gsd, cropPreset(Crop::kSugarBeet10m).uav.gsd);
}

TEST(Simulate, EveryCropGivesCloudsOfTheExpectedSizeAndExtent) {
  for (const Crop crop : {Crop::kSoybean, Crop::kWinterWheat, Crop::kMaize}) {
    const SimulationOptions options = smallOptions(crop);
    const SimulatedPair pair = simulatePair(options);
    const double lattice = 36.0 / (options.uav.gsd * options.uav.gsd);
    EXPECT_NEAR(static_cast<double>(pair.uav.size()), lattice, 0.06 * lattice);
    const double samples = 5.0 * 1.6 / (0.006 * 0.006);
    EXPECT_GT(static_cast<double>(pair.ugv.size()), 0.25 * samples);
    EXPECT_LT(static_cast<double>(pair.ugv.size()), 1.3 * samples);
    ASSERT_EQ(pair.truth.size(), pair.ugv.size());
    ASSERT_EQ(pair.ugv.rgb.size(), pair.ugv.size());
    ASSERT_EQ(pair.uav.rgb.size(), pair.uav.size());
    const Box3 box = boundingBox(pair.uav);
    EXPECT_LT(box.extent().x(), 6.01F);
    EXPECT_GT(box.extent().x(), 5.9F);
    EXPECT_LT(box.extent().z(), 2.5F);
    EXPECT_TRUE(pair.overlaps);
  }
}

TEST(Simulate, NominalIsTheTruthWithoutDrift) {
  SimulationOptions options = smallOptions();
  options.ugv.drift = 0.0;
  const SimulatedPair exact = simulatePair(options);
  EXPECT_LT(rms(exact, exact.nominal), 2e-6);
  EXPECT_LT(rms(exact, exact.best_affine), 2e-6);
  EXPECT_LT((exact.best_affine.linear() - exact.nominal.linear()).norm(), 1e-5);

  options.ugv.drift = 0.01;
  const SimulatedPair drifted = simulatePair(options);
  const double best = rms(drifted, drifted.best_affine);
  EXPECT_GT(best, 0.0005);
  EXPECT_LT(best, rms(drifted, drifted.nominal));
  EXPECT_LT(rms(drifted, drifted.nominal), 0.01 * options.ugv.length);
}

TEST(Simulate, PriorHasTheErrorsAskedFor) {
  SimulationOptions options = smallOptions();
  options.geotag.translation = 2.5;
  options.geotag.heading_deg = 5.0;
  options.geotag.scale = 0.2;
  options.geotag.tilt_deg = 0.0;
  options.geotag.file_heading_deg = 40.0;
  const SimulatedPair pair = simulatePair(options);
  const Eigen::Vector3d centre_in_file = pair.nominal.inverse() * pair.strip_centre;
  const Eigen::Vector3d error = pair.prior * centre_in_file - pair.strip_centre;
  EXPECT_NEAR(error.head<2>().norm(), 2.5, 1e-6);
  EXPECT_NEAR(std::abs(error.z()), options.geotag.z, 1e-6);
  const Eigen::Matrix3d between = pair.prior.linear().inverse() * pair.nominal.linear();
  const double turn = std::atan2(between(1, 0), between(0, 0));
  EXPECT_NEAR(degrees(std::abs(turn)), 5.0, 1e-9);
  for (int k = 0; k < 2; ++k) {
    const double file_over_field = 1.0 / between.col(k).norm();
    EXPECT_NEAR(std::abs(file_over_field - 1.0), 0.2, 1e-9);
  }
  EXPECT_NEAR(degrees(std::atan2(pair.prior(1, 0), pair.prior(0, 0))), 40.0, 1e-9);
}

TEST(Simulate, GeoreferencedFilesNeedNoPrior) {
  SimulationOptions options = smallOptions();
  options.geotag.ugv_georeferenced = true;
  const SimulatedPair pair = simulatePair(options);
  EXPECT_TRUE(pair.prior.isApprox(Eigen::Affine3d::Identity()));
  // UTM coordinates in both files, precise to a hundredth of a millimetre.
  EXPECT_GT(pair.ugv.origin.y(), 1e6);
  EXPECT_GT(pair.uav.origin.y(), 1e6);
  EXPECT_LT(boundingBox(pair.ugv).extent().maxCoeff(), 20.0F);
  EXPECT_LT(boundingBox(pair.uav).max.cwiseAbs().maxCoeff(), 20.0F);
}

TEST(Simulate, SameBitsOnAnyNumberOfThreads) {
  SimulationOptions options = smallOptions(Crop::kSoybean);
  const auto run = [&](int threads) {
    const ThreadLimit limit(threads);
    return simulatePair(options);
  };
  const SimulatedPair one = run(1);
  const SimulatedPair many = run(4);
  EXPECT_EQ(one.uav.xyz, many.uav.xyz);
  EXPECT_EQ(one.uav.rgb, many.uav.rgb);
  EXPECT_EQ(one.ugv.xyz, many.ugv.xyz);
  EXPECT_EQ(one.ugv.rgb, many.ugv.rgb);
  EXPECT_EQ(one.truth, many.truth);
  EXPECT_EQ(one.best_affine.matrix(), many.best_affine.matrix());
  options.seed = 8;
  EXPECT_NE(run(2).uav.xyz, one.uav.xyz);
}

TEST(Simulate, UnsharedLeavesAndOtherFieldsLookDifferent) {
  SimulationOptions options = smallOptions();
  options.views.leaf_unshared = 0.0;
  const double shared = correlation(options);
  options.views.leaf_unshared = 1.0;
  const double unshared = correlation(options);
  options.views.leaf_unshared = 0.0;
  options.other_field = true;
  const double other = correlation(options);
  EXPECT_GT(shared, 0.7);
  EXPECT_LT(unshared, shared - 0.15);
  EXPECT_LT(other, unshared - 0.15);
}

TEST(Simulate, OtherFieldIsMarkedAsNegative) {
  SimulationOptions options = smallOptions();
  options.other_field = true;
  EXPECT_FALSE(simulatePair(options).overlaps);
}

TEST(Field, GivesThePairAndOtherStripsOfTheSameView) {
  const SimulationOptions options = smallOptions();
  const SimulatedPair pair = simulatePair(options);
  const SimulatedField field(options);
  EXPECT_EQ(field.uav().xyz, pair.uav.xyz);
  EXPECT_EQ(field.uav().rgb, pair.uav.rgb);
  const SimulatedStrip first = field.strip(options);
  EXPECT_EQ(first.ugv.xyz, pair.ugv.xyz);
  EXPECT_EQ(first.truth, pair.truth);
  EXPECT_EQ(first.prior.matrix(), pair.prior.matrix());
  const SimulatedStrip second = field.strip(options, 1);
  EXPECT_GT((second.strip_centre - first.strip_centre).norm(), 0.01);
  EXPECT_EQ(field.strip(options, 1).ugv.xyz, second.ugv.xyz);
  EXPECT_NE(field.strip(options, 2).ugv.xyz, second.ugv.xyz);
  // What is in the strip is what the drone saw there.
  const auto likeness = [&](const SimulatedStrip& strip) {
    return correlation({strip, field.uav()}, options);
  };
  EXPECT_GT(likeness(second), 0.5);
}

TEST(Field, StripsMayDifferInAllButTheField) {
  SimulationOptions options = smallOptions();
  const SimulatedField field(options);
  options.views.growth = 1.4;
  options.ugv.length = 4.0;
  options.geotag.translation = 3.0;
  EXPECT_NO_THROW(field.strip(options, 1));
  options.field.gaps = 0.5;
  EXPECT_THROW(field.strip(options, 1), UsageError);
  options = smallOptions();
  options.seed += 1;
  EXPECT_THROW(field.strip(options, 1), UsageError);
}

TEST(Field, StripsWithoutARightPlaceLookLikeNothingInTheMap) {
  SimulationOptions options = smallOptions();
  const SimulatedField field(options);
  const double right = correlation({field.strip(options), field.uav()}, options);
  SimulationOptions beyond = options;
  beyond.beyond_map = true;
  SimulationOptions mirrored = options;
  mirrored.mirrored = true;
  for (const SimulationOptions& wrong : {beyond, mirrored}) {
    const SimulatedStrip strip = field.strip(wrong);
    EXPECT_FALSE(strip.overlaps);
    EXPECT_LT(correlation({strip, field.uav()}, options), right - 0.3);
    // It claims to lie where the right strip lies, at its height.
    EXPECT_LT((strip.strip_centre - field.strip(options).strip_centre).norm(), 0.1);
  }
}

TEST(Geotag, CanMissByRowsAndLoseItsUnit) {
  SimulationOptions options = smallOptions();
  options.geotag = {};
  options.geotag.translation = options.geotag.heading_deg = options.geotag.scale = 0.0;
  options.geotag.tilt_deg = options.geotag.z = 0.0;
  const SimulatedField field(options);
  const auto centreError = [](const SimulatedStrip& strip) {
    return Eigen::Vector3d(strip.prior * (strip.nominal.inverse() * strip.strip_centre) -
                           strip.strip_centre);
  };
  EXPECT_LT(centreError(field.strip(options)).norm(), 1e-6);
  options.geotag.across_rows = 0.5;
  const SimulatedStrip aside = field.strip(options);
  const Eigen::Vector3d along(std::cos(aside.row_heading), std::sin(aside.row_heading), 0.0);
  EXPECT_NEAR(centreError(aside).norm(), 0.5, 1e-6);
  EXPECT_NEAR(centreError(aside).dot(along), 0.0, 1e-6);

  options.geotag.across_rows = 0.0;
  options.geotag.unknown_scale = 10.0;
  double smallest = 1e9;
  double largest = 0.0;
  for (int index = 0; index < 8; ++index) {
    const SimulatedStrip strip = field.strip(options, index);
    const double factor = std::cbrt(strip.nominal.linear().determinant());
    smallest = std::min(smallest, factor);
    largest = std::max(largest, factor);
    // The prior knows nothing of it, the truth does.
    EXPECT_NEAR(strip.prior.linear().determinant(), 1.0, 1e-9);
    // The diagonal of a box around 5 m x 1.6 m at some angle.
    EXPECT_NEAR(factor * static_cast<double>(boundingBox(strip.ugv).extent().head<2>().norm()), 6.0,
                1.0);
  }
  EXPECT_GE(smallest, 0.1);
  EXPECT_LE(largest, 10.0);
  EXPECT_GT(largest / smallest, 3.0);
}

TEST(Geotag, HasAVerticalScaleOfItsOwn) {
  SimulationOptions options = smallOptions(Crop::kSugarBeet10m);
  options.geotag.tilt_deg = 0.0;
  const SimulatedField field(options);
  const auto upOf = [](const SimulatedStrip& strip) {
    return strip.nominal.linear().col(2).norm();
  };
  const SimulatedStrip metres = field.strip(options);
  EXPECT_NEAR(upOf(metres), 1.0, 1e-9);
  options.geotag.vertical_scale = 0.2;
  const SimulatedStrip stretched = field.strip(options);
  EXPECT_NEAR(std::abs(1.0 / upOf(stretched) - 1.0), 0.2, 1e-9);
  // All else is as it was.
  EXPECT_TRUE(
      stretched.nominal.linear().leftCols<2>().isApprox(metres.nominal.linear().leftCols<2>()));
}

TEST(Simulate, PlantsHideTheGroundBehindThem) {
  // Cells that the drone fills and the robot does not: many more with a low camera in a tall crop.
  const auto missing = [](double camera_height) {
    SimulationOptions options = smallOptions(Crop::kSoybean);
    options.ugv.camera_height = camera_height;
    const SimulatedPair pair = simulatePair(options);
    const StripMap above = mapFromAbove(pair, options);
    const StripMap below = mapFromGround(pair, options);
    int empty = 0;
    int all = 0;
    for (std::size_t i = 0; i < above.count.size(); ++i) {
      if (above.count[i] == 0.0F) continue;
      ++all;
      empty += below.count[i] == 0.0F ? 1 : 0;
    }
    return static_cast<double>(empty) / all;
  };
  EXPECT_GT(missing(0.5), missing(4.0) + 0.05);
}

TEST(Simulate, GapsThinTheField) {
  const auto shareAt = [](double gaps) {
    SimulationOptions options = smallOptions(Crop::kSoybean);
    options.field.gaps = gaps;
    return greenShare(SimulatedField(options).uav());
  };
  const double dense = shareAt(0.0);
  const double sparse = shareAt(0.7);
  EXPECT_GT(dense, 0.3);
  EXPECT_LT(sparse, 0.75 * dense);
}

TEST(Simulate, OverhangLeavesTheMap) {
  SimulationOptions options = smallOptions();
  options.field.random_row_heading = false;
  options.ugv.overhang = 0.4;
  const SimulatedPair pair = simulatePair(options);
  const double border = pair.uav.origin.x() + options.field.width;
  const auto outside = std::count_if(pair.truth.begin(), pair.truth.end(),
                                     [&](const Eigen::Vector3d& p) { return p.x() > border; });
  EXPECT_NEAR(static_cast<double>(outside) / static_cast<double>(pair.truth.size()), 0.4, 0.05);
}

TEST(Simulate, RefusesWhatCannotBe) {
  SimulationOptions options = smallOptions();
  options.ugv.length = 30.0;
  EXPECT_THROW(simulatePair(options), UsageError);
  options = smallOptions();
  options.views.leaf_unshared = 1.5;
  EXPECT_THROW(simulatePair(options), UsageError);
}

}  // namespace
}  // namespace agricolmap::simulate
