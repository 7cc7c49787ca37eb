// The whole pipeline through its C++ API, on simulated pairs with exact truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap {
namespace {

simulate::SimulatedPair smallPair(int seed, bool other_field = false) {
  simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
  options.field.width = 14.0;
  options.field.height = 14.0;
  options.ugv.length = 6.0;
  options.seed = seed;
  options.other_field = other_field;
  return simulate::simulatePair(options);
}

pipeline::Registration registerPair(const simulate::SimulatedPair& pair) {
  Monitor monitor;
  return pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, pipeline::preset("default"),
                                  monitor);
}

TEST(Pipeline, FindsTheTruthInUtmCoordinates) {
  const simulate::SimulatedPair pair = smallPair(7);
  ASSERT_GT(pair.uav.origin.norm(), 1e6);
  const pipeline::Registration result = registerPair(pair);
  ASSERT_TRUE(result.transform);
  EXPECT_EQ(result.verdict.status, verdict::Status::kAccepted);
  const evaluate::RegistrationErrors errors = evaluate::evaluateTransform(
      result.transform->fixed_from_moving, {pair.best_affine, pair.truth}, pair.ugv);
  EXPECT_TRUE(errors.within({})) << "RMS " << errors.rms << " m, e_t " << errors.translation;
  EXPECT_LT(errors.rms, 0.03);
  // The initial guess was not already that good.
  EXPECT_GT(evaluate::evaluateTransform(pair.prior, {pair.best_affine, pair.truth}, pair.ugv).rms,
            0.5);
}

/// Placed by pieces, and what drift bent is followed, on one thread as on several.
TEST(Pipeline, FollowsALongStripPieceByPiece) {
  simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
  options.field.width = options.field.height = 34.0;
  options.uav.gsd = 0.03;
  options.uav.canvas = 0.015;
  options.ugv.length = 28.0;
  options.ugv.width = 1.8;
  options.ugv.spacing = 0.012;
  options.ugv.drift = 0.03;
  options.seed = 11;
  const simulate::SimulatedPair pair = simulate::simulatePair(options);
  const pipeline::Registration result = registerPair(pair);
  EXPECT_EQ(result.verdict.status, verdict::Status::kAccepted) << result.verdict.reasons.front();
  EXPECT_GT(result.trace.pieces.size(), 4U);
  ASSERT_TRUE(result.transform);
  const auto rmsOf = [&](const Cloud& cloud, const Eigen::Affine3d& transform) {
    double sum = 0.0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      sum += (transform * cloud.filePoint(i) - pair.truth[i]).head<2>().squaredNorm();
    }
    return std::sqrt(sum / static_cast<double>(cloud.size()));
  };
  const double best = rmsOf(pair.ugv, pair.best_affine);
  EXPECT_GT(best, 0.04);
  EXPECT_LT(rmsOf(pair.ugv, result.transform->fixed_from_moving), 1.2 * best);
  const Cloud aligned = pipeline::alignedCloud(result, pair.ugv);
  EXPECT_LT(rmsOf(aligned, Eigen::Affine3d::Identity()), 0.5 * best);
  const ThreadLimit limit(1);
  const pipeline::Registration alone = registerPair(pair);
  ASSERT_TRUE(alone.transform);
  EXPECT_EQ(alone.transform->fixed_from_moving.matrix(),
            result.transform->fixed_from_moving.matrix());
  // The path of its odometry serves as well as its shape.
  Monitor monitor;
  const pipeline::Registration with_path = pipeline::registerClouds(
      pair.uav, pair.ugv, pair.prior, pipeline::preset("default"), monitor, {}, pair.path);
  EXPECT_EQ(with_path.verdict.status, verdict::Status::kAccepted);
}

double rmsOf(const Cloud& cloud, const std::vector<Eigen::Vector3d>& truth) {
  double sum = 0.0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    sum += (cloud.filePoint(i) - truth[i]).head<2>().squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(cloud.size()));
}

/// `shift(along)` in the file, along the way [m].
template <typename Shift>
simulate::SimulatedPair slippedPair(const Shift& shift) {
  simulate::SimulationOptions options = simulate::cropPreset(simulate::Crop::kSugarBeet10m);
  options.field.width = options.field.height = 16.0;
  options.ugv.length = 8.0;
  options.ugv.spacing = 0.008;
  options.geotag.file_heading_deg = 0.0;
  options.seed = 21;
  simulate::SimulatedPair pair = simulate::simulatePair(options);
  const Eigen::Vector3d ahead(std::cos(pair.strip_heading), std::sin(pair.strip_heading), 0.0);
  const Eigen::Matrix3d in_file = pair.nominal.linear().inverse();
  for (std::size_t i = 0; i < pair.truth.size(); ++i) {
    const double along = ahead.dot(pair.truth[i] - pair.strip_centre);
    pair.ugv.xyz[i] += (in_file * shift(along, ahead)).template cast<float>();
  }
  return pair;
}

/// The pose of a strip in three parts is a compromise: what is straight again is refined again.
TEST(Pipeline, FollowsAStripThatSlippedTwice) {
  const simulate::SimulatedPair pair =
      slippedPair([](double along, const Eigen::Vector3d& ahead) -> Eigen::Vector3d {
        const Eigen::Vector3d left(-ahead.y(), ahead.x(), 0.0);
        return along > 1.5 ? 0.25 * ahead : along < -1.5 ? 0.25 * left : 0.0 * left;
      });
  const pipeline::Registration result = registerPair(pair);
  EXPECT_EQ(result.verdict.status, verdict::Status::kAccepted) << result.verdict.reasons.front();
  ASSERT_TRUE(result.bent());
  EXPECT_LT(rmsOf(pipeline::alignedCloud(result, pair.ugv), pair.truth), 0.025);
}

/// Which of the points belongs where nobody can tell where parts lie over one another.
TEST(Pipeline, StatesWhatOverlappingPartsAreOffBy) {
  const simulate::SimulatedPair pair =
      slippedPair([](double along, const Eigen::Vector3d& ahead) -> Eigen::Vector3d {
        return along > 1.5 ? Eigen::Vector3d(-0.3 * ahead) : Eigen::Vector3d(0.0 * ahead);
      });
  const pipeline::Registration result = registerPair(pair);
  EXPECT_NE(result.verdict.status, verdict::Status::kAccepted);
  ASSERT_TRUE(result.bent() && result.placed->uncertainty);
  const double error = rmsOf(pipeline::alignedCloud(result, pair.ugv), pair.truth);
  EXPECT_GT(error, 0.04);
  EXPECT_NEAR(result.placed->uncertainty->expected_rms, error, 0.02);
}

TEST(Pipeline, ItsStagesAddUpToTheTimeItTook) {
  const simulate::SimulatedPair pair = smallPair(9);
  for (const char* name : {"default", "paper"}) {
    Monitor monitor;
    pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, pipeline::preset(name), monitor);
    const double wall = monitor.seconds();
    double sum = 0.0;
    for (const StageTime& time : monitor.times()) sum += time.seconds;
    EXPECT_GE(sum, 0.97 * wall) << name;
    EXPECT_LE(sum, wall) << name;
  }
}

TEST(Pipeline, WhereTheFieldLiesMakesNoDifference) {
  const simulate::SimulatedPair pair = smallPair(8);
  const pipeline::Registration here = registerPair(pair);
  // By whole metres and powers of two, so that the sums are exact.
  const Eigen::Vector3d far(262144.0, -131072.0, 64.0);
  simulate::SimulatedPair moved = pair;
  moved.uav.origin += far;
  moved.prior = Eigen::Translation3d(far) * pair.prior;
  const pipeline::Registration there = registerPair(moved);
  ASSERT_TRUE(here.transform);
  ASSERT_TRUE(there.transform);
  const Eigen::Affine3d back = Eigen::Translation3d(-far) * there.transform->fixed_from_moving;
  double worst = 0.0;
  for (std::size_t i = 0; i < pair.ugv.size(); i += 1000) {
    const Eigen::Vector3d point = pair.ugv.filePoint(i);
    worst = std::max(worst, (back * point - here.transform->fixed_from_moving * point).norm());
  }
  EXPECT_LT(worst, 1e-4);
}

TEST(Pipeline, ReportsThePartsOfItsTransform) {
  const simulate::SimulatedPair pair = smallPair(9);
  const pipeline::Registration result = registerPair(pair);
  ASSERT_TRUE(result.transform);
  // Parts are relative to the guess: the geotag's errors were 2 degrees and 5 percent.
  EXPECT_NEAR(std::abs(result.transform->parts.yaw) * 180.0 / 3.14159265358979, 2.0, 1.0);
  EXPECT_NEAR(std::abs(std::log(result.transform->parts.scale_x)), 0.05, 0.02);
  EXPECT_NEAR(std::abs(std::log(result.transform->parts.scale_y)), 0.05, 0.02);
  const Eigen::Affine3d composed = Eigen::Translation3d(pair.uav.origin) *
                                   result.transform->local_fixed_from_moving *
                                   Eigen::Translation3d(-pair.ugv.origin);
  EXPECT_TRUE(composed.isApprox(result.transform->fixed_from_moving, 1e-9));
}

TEST(Pipeline, RejectsTheStripOfAnotherField) {
  EXPECT_EQ(registerPair(smallPair(10, /*other_field=*/true)).verdict.status,
            verdict::Status::kRejected);
}

TEST(Pipeline, FindsTheStripWithoutAGuess) {
  const simulate::SimulatedPair pair = smallPair(11);
  pipeline::RegistrationOptions options = pipeline::preset("default");
  options.prior = PriorUncertainty::none();
  Monitor monitor;
  // Half way round, and kilometres off.
  const Eigen::Affine3d guess = Eigen::Translation3d(3000.0, -1000.0, 50.0) * pair.prior *
                                Eigen::AngleAxisd(2.8, Eigen::Vector3d::UnitZ());
  const pipeline::Registration result =
      pipeline::registerClouds(pair.uav, pair.ugv, guess, options, monitor);
  ASSERT_EQ(result.verdict.status, verdict::Status::kAccepted);
  EXPECT_LT(evaluate::evaluateTransform(result.transform->fixed_from_moving,
                                        {pair.best_affine, pair.truth}, pair.ugv)
                .rms,
            0.05);
}

TEST(Pipeline, TwoEqualFieldsAreAmbiguous) {
  simulate::SimulatedPair pair = smallPair(12);
  Cloud& field = pair.uav;
  const std::size_t count = field.size();
  for (std::size_t i = 0; i < count; ++i) {
    field.xyz.push_back(field.xyz[i] + Eigen::Vector3f(15.0F, 0.0F, 0.0F));
    field.rgb.push_back(field.rgb[i]);
  }
  pipeline::RegistrationOptions options = pipeline::preset("default");
  options.prior.translation = kAnywhere;
  Monitor monitor;
  const pipeline::Registration result =
      pipeline::registerClouds(field, pair.ugv, pair.prior, options, monitor);
  ASSERT_EQ(result.verdict.status, verdict::Status::kAmbiguous);
  EXPECT_LE(result.verdict.plane_probability, 0.5);
  ASSERT_EQ(result.alternatives.size(), 1U);
  // One of the two places is the truth, and the other lies 15 m beside it.
  const evaluate::Truth truth{pair.best_affine, pair.truth};
  const double here =
      evaluate::evaluateTransform(result.transform->fixed_from_moving, truth, pair.ugv).rms;
  const double there =
      evaluate::evaluateTransform(result.alternatives[0].fixed_from_moving, truth, pair.ugv).rms;
  EXPECT_LT(std::min(here, there), 0.06);
  EXPECT_NEAR(std::max(here, there), 15.0, 0.1);
}

TEST(Pipeline, FindsAnUnknownScale) {
  simulate::SimulatedPair pair = smallPair(13);
  constexpr float kUnit = 0.4F;  // as a map from a single camera has it
  pair.ugv.origin *= static_cast<double>(kUnit);
  for (Eigen::Vector3f& p : pair.ugv.xyz) p *= kUnit;
  pipeline::RegistrationOptions options = pipeline::preset("default");
  options.prior = PriorUncertainty::none();
  options.prior.scale_unknown = true;
  Monitor monitor;
  const pipeline::Registration result =
      pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, options, monitor);
  ASSERT_EQ(result.verdict.status, verdict::Status::kAccepted);
  const evaluate::Truth truth{Eigen::Affine3d::Identity(), pair.truth};
  EXPECT_LT(evaluate::evaluateTransform(result.transform->fixed_from_moving, truth, pair.ugv).rms,
            0.05);
  EXPECT_NEAR(result.transform->parts.scale_x, 1.0 / static_cast<double>(kUnit), 0.2);
  EXPECT_NEAR(result.transform->vertical_scale, 1.0 / static_cast<double>(kUnit), 0.2);
  // No map of the strip before its scale is known is no flat one.
  for (const std::string& warning : monitor.warnings()) {
    EXPECT_EQ(warning.find("flat"), std::string::npos) << warning;
  }
}

TEST(Pipeline, TheFlowCannotSearchEverywhere) {
  const simulate::SimulatedPair pair = smallPair(7);
  pipeline::RegistrationOptions options = pipeline::preset("paper");
  options.prior.scale_unknown = true;
  Monitor monitor;
  EXPECT_THROW(pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, options, monitor),
               UsageError);
}

TEST(Pipeline, RefusesOptionsOutsideTheirLimits) {
  const simulate::SimulatedPair pair = smallPair(7);
  pipeline::RegistrationOptions options = pipeline::preset("default");
  options.grid.cell = -1.0;
  Monitor monitor;
  EXPECT_THROW(pipeline::registerClouds(pair.uav, pair.ugv, pair.prior, options, monitor),
               UsageError);
}

/// The cloud laid flat, as an orthomosaic is.
Cloud flat(const Cloud& cloud) {
  Cloud made = cloud;
  for (Eigen::Vector3f& point : made.xyz) point.z() = 0.0F;
  return made;
}

TEST(Pipeline, CloudsWithoutHeightsAreRegisteredByTheirColoursAndItSaysSo) {
  const simulate::SimulatedPair pair = smallPair(7);
  Monitor monitor;
  const pipeline::Registration result = pipeline::registerClouds(
      flat(pair.uav), flat(pair.ugv), pair.prior, pipeline::preset("default"), monitor);
  EXPECT_EQ(result.verdict.status, verdict::Status::kAccepted);
  ASSERT_TRUE(result.transform);
  const evaluate::RegistrationErrors errors = evaluate::evaluateTransform(
      result.transform->fixed_from_moving, {pair.best_affine, pair.truth}, pair.ugv);
  EXPECT_LT(errors.rms_horizontal, 0.05);
  EXPECT_TRUE(std::any_of(
      monitor.warnings().begin(), monitor.warnings().end(),
      [](const std::string& text) { return text.find("is flat") != std::string::npos; }));
}

TEST(Pipeline, MirroredStripsAreRefused) {
  std::vector<double> probabilities;
  for (int seed = 1; seed <= 3; ++seed) {
    simulate::SimulatedPair pair = smallPair(seed);
    float low = pair.ugv.xyz.front().y(), high = low;
    for (const Eigen::Vector3f& point : pair.ugv.xyz) {
      low = std::min(low, point.y());
      high = std::max(high, point.y());
    }
    for (Eigen::Vector3f& point : pair.ugv.xyz) point.y() = low + high - point.y();
    const pipeline::Registration result = registerPair(pair);
    EXPECT_EQ(result.verdict.status, verdict::Status::kRejected) << seed;
    probabilities.push_back(result.verdict.place_probability);
  }
  std::sort(probabilities.begin(), probabilities.end());
  EXPECT_LT(probabilities[1], 0.1);
  EXPECT_LT(probabilities[2], 0.4);
}

}  // namespace
}  // namespace agricolmap
