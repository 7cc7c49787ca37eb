// The whole pipeline through its C++ API, on simulated pairs with exact truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap {
namespace {

SimulatedPair smallPair(int seed, bool other_field = false) {
  SimulationOptions options = cropPreset(Crop::kSugarBeet10m);
  options.field.width = 14.0;
  options.field.height = 14.0;
  options.ugv.length = 6.0;
  options.seed = seed;
  options.other_field = other_field;
  return simulatePair(options);
}

Registration registerPair(const SimulatedPair& pair) {
  StageTimes times;
  return registerClouds(pair.uav, pair.ugv, pair.prior, preset("default"), times);
}

TEST(Pipeline, FindsTheTruthInUtmCoordinates) {
  const SimulatedPair pair = smallPair(7);
  ASSERT_GT(pair.uav.origin.norm(), 1e6);
  const Registration result = registerPair(pair);
  ASSERT_TRUE(result.has_transform);
  EXPECT_EQ(result.verdict.status, Status::kAccepted);
  const RegistrationErrors errors =
      evaluateTransform(result.fixed_from_moving, {pair.best_affine, pair.truth}, pair.ugv);
  EXPECT_TRUE(errors.within({})) << "RMS " << errors.rms << " m, e_t " << errors.translation;
  EXPECT_LT(errors.rms, 0.03);
  // The initial guess was not already that good.
  EXPECT_GT(evaluateTransform(pair.prior, {pair.best_affine, pair.truth}, pair.ugv).rms, 0.5);
}

TEST(Pipeline, WhereTheFieldLiesMakesNoDifference) {
  const SimulatedPair pair = smallPair(8);
  const Registration here = registerPair(pair);
  // By whole metres and powers of two, so that the sums are exact.
  const Eigen::Vector3d far(262144.0, -131072.0, 64.0);
  SimulatedPair moved = pair;
  moved.uav.origin += far;
  moved.prior = Eigen::Translation3d(far) * pair.prior;
  const Registration there = registerPair(moved);
  ASSERT_TRUE(here.has_transform);
  ASSERT_TRUE(there.has_transform);
  const Eigen::Affine3d back = Eigen::Translation3d(-far) * there.fixed_from_moving;
  double worst = 0.0;
  for (std::size_t i = 0; i < pair.ugv.size(); i += 1000) {
    const Eigen::Vector3d point = pair.ugv.filePoint(i);
    worst = std::max(worst, (back * point - here.fixed_from_moving * point).norm());
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(Pipeline, ReportsThePartsOfItsTransform) {
  const SimulatedPair pair = smallPair(9);
  const Registration result = registerPair(pair);
  ASSERT_TRUE(result.has_transform);
  // Parts are relative to the guess: the geotag's errors were 2 degrees and 5 percent.
  EXPECT_NEAR(std::abs(result.parts.yaw) * 180.0 / 3.14159265358979, 2.0, 1.0);
  EXPECT_NEAR(std::abs(std::log(result.parts.scale_x)), 0.05, 0.02);
  EXPECT_NEAR(std::abs(std::log(result.parts.scale_y)), 0.05, 0.02);
  const Eigen::Affine3d composed = Eigen::Translation3d(pair.uav.origin) *
                                   result.local_fixed_from_moving *
                                   Eigen::Translation3d(-pair.ugv.origin);
  EXPECT_TRUE(composed.isApprox(result.fixed_from_moving, 1e-9));
}

TEST(Pipeline, RejectsTheStripOfAnotherField) {
  EXPECT_EQ(registerPair(smallPair(10, /*other_field=*/true)).verdict.status, Status::kRejected);
}

TEST(Pipeline, FindsTheStripWithoutAGuess) {
  const SimulatedPair pair = smallPair(11);
  RegistrationOptions options = preset("default");
  options.prior = PriorUncertainty::none();
  StageTimes times;
  // Half way round, and kilometres off.
  const Eigen::Affine3d guess = Eigen::Translation3d(3000.0, -1000.0, 50.0) * pair.prior *
                                Eigen::AngleAxisd(2.8, Eigen::Vector3d::UnitZ());
  const Registration result = registerClouds(pair.uav, pair.ugv, guess, options, times);
  ASSERT_EQ(result.verdict.status, Status::kAccepted);
  EXPECT_LT(
      evaluateTransform(result.fixed_from_moving, {pair.best_affine, pair.truth}, pair.ugv).rms,
      0.05);
}

TEST(Pipeline, TwoEqualFieldsAreAmbiguous) {
  SimulatedPair pair = smallPair(12);
  Cloud& field = pair.uav;
  const std::size_t count = field.size();
  for (std::size_t i = 0; i < count; ++i) {
    field.xyz.push_back(field.xyz[i] + Eigen::Vector3f(15.0F, 0.0F, 0.0F));
    field.rgb.push_back(field.rgb[i]);
  }
  RegistrationOptions options = preset("default");
  options.prior.translation = kAnywhere;
  StageTimes times;
  const Registration result = registerClouds(field, pair.ugv, pair.prior, options, times);
  ASSERT_EQ(result.verdict.status, Status::kAmbiguous);
  EXPECT_LE(result.verdict.probability, 0.5);
  ASSERT_EQ(result.alternatives.size(), 1U);
  // One of the two places is the truth, and the other lies 15 m beside it.
  const Truth truth{pair.best_affine, pair.truth};
  const double here = evaluateTransform(result.fixed_from_moving, truth, pair.ugv).rms;
  const double there =
      evaluateTransform(result.alternatives[0].fixed_from_moving, truth, pair.ugv).rms;
  EXPECT_LT(std::min(here, there), 0.06);
  EXPECT_NEAR(std::max(here, there), 15.0, 0.1);
}

TEST(Pipeline, FindsAnUnknownScale) {
  SimulatedPair pair = smallPair(13);
  constexpr float kUnit = 0.4F;  // as a map from a single camera has it
  pair.ugv.origin *= static_cast<double>(kUnit);
  for (Eigen::Vector3f& p : pair.ugv.xyz) p *= kUnit;
  RegistrationOptions options = preset("default");
  options.prior = PriorUncertainty::none();
  options.prior.scale_unknown = true;
  StageTimes times;
  const Registration result = registerClouds(pair.uav, pair.ugv, pair.prior, options, times);
  ASSERT_EQ(result.verdict.status, Status::kAccepted);
  const Truth truth{Eigen::Affine3d::Identity(), pair.truth};
  EXPECT_LT(evaluateTransform(result.fixed_from_moving, truth, pair.ugv).rms, 0.05);
  EXPECT_NEAR(result.parts.scale_x, 1.0 / static_cast<double>(kUnit), 0.2);
  EXPECT_NEAR(result.vertical_scale, 1.0 / static_cast<double>(kUnit), 0.2);
}

TEST(Pipeline, TheFlowCannotSearchEverywhere) {
  const SimulatedPair pair = smallPair(7);
  RegistrationOptions options = preset("paper");
  options.prior.scale_unknown = true;
  StageTimes times;
  EXPECT_THROW(registerClouds(pair.uav, pair.ugv, pair.prior, options, times), UsageError);
}

TEST(Pipeline, RefusesOptionsOutsideTheirLimits) {
  const SimulatedPair pair = smallPair(7);
  RegistrationOptions options = preset("default");
  options.grid.cell = -1.0;
  StageTimes times;
  EXPECT_THROW(registerClouds(pair.uav, pair.ugv, pair.prior, options, times), UsageError);
}

}  // namespace
}  // namespace agricolmap
