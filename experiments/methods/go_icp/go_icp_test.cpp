// Go-ICP: its distance field, that its bounds do not lose the answer, and the method.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/random.hpp"
#include "experiments/methods/go_icp/branch_and_bound.hpp"
#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

std::vector<Eigen::Vector3d> scattered(int count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(random.uniform(-3.0, 3.0), random.uniform(-2.0, 2.0),
                        random.uniform(0.0, 0.2));
  }
  return points;
}

TEST(DistanceField, IsTheDistanceToTheNearestPoint) {
  const std::vector<Eigen::Vector3d> points = scattered(60, 3);
  const DistanceField field(points, 0.05, 0.3);
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p(random.uniform(-3.0, 3.0), random.uniform(-2.0, 2.0),
                            random.uniform(-0.2, 0.4));
    double nearest = 1e9;
    for (const Eigen::Vector3d& q : points) nearest = std::min(nearest, (p - q).norm());
    EXPECT_NEAR(static_cast<double>(field.at(p.cast<float>())), nearest, 0.09);
  }
  // Outside: no less than the way back to the field.
  EXPECT_GT(field.at(Eigen::Vector3f(10.0F, 0.0F, 0.0F)), 6.0F);
}

TEST(GoIcpSearcher, FindsAMotionFromFaraway) {
  const std::vector<Eigen::Vector3d> fixed = scattered(400, 5);
  const DistanceField field(fixed, 0.03, 0.3);
  const Eigen::AngleAxisd turn(0.13, Eigen::Vector3d::UnitZ());
  const Eigen::Vector3d shift(0.9, -0.6, 0.05);
  std::vector<Eigen::Vector3d> moving;
  for (const Eigen::Vector3d& p : fixed) {
    const Eigen::Vector3d q = turn.inverse() * (p - shift);
    if (std::abs(q.x()) < 1.2 && std::abs(q.y()) < 0.8) moving.push_back(q);
  }
  ASSERT_GT(moving.size(), 40U);
  GoIcpSearch search;
  search.half_rotation = 0.2;
  search.half_translation = 1.5;
  search.trim = 0.1;
  search.threshold = 1e-3;
  const GoIcpSearcher searcher(field, moving, search, 60.0);
  // Without any local search: bounds alone must lead there.
  const GoIcpResult result = searcher.run([&](GoIcpPose pose) {
    pose.error = searcher.errorOf(pose);
    return pose;
  });
  EXPECT_TRUE(result.proven);
  EXPECT_LT((result.pose.translation - shift).norm(), 0.15);
  EXPECT_NEAR(result.pose.rotation.z(), 0.13, 0.08);
}

PriorUncertainty nearPrior() {
  PriorUncertainty prior;
  prior.translation = 0.6;
  prior.heading_deg = 2.0;
  prior.scale = 0.0;
  return prior;
}

MethodOutcome runOn(const Method& method, const testing::GuessError& error, bool truth) {
  MethodInput input = testing::inputOf(testing::smallPair(), error, nearPrior());
  if (truth) input.truth = testing::smallPair().best_affine;
  return method.run(input);
}

TEST(GoIcp, IsRightWithoutScaleError) {
  testing::GuessError error;
  error.shift = {0.45, -0.3};
  const MethodOutcome outcome = runOn(makeMethod("go-icp"), error, false);
  ASSERT_TRUE(outcome.fixed_from_moving.has_value()) << outcome.why;
  EXPECT_TRUE(testing::errorsOf(outcome, testing::smallPair()).within({}))
      << testing::errorsOf(outcome, testing::smallPair()).rms;
}

TEST(GoIcp, OracleScaleMendsItsScale) {
  testing::GuessError error;
  error.shift = {0.3, 0.2};
  error.scale = {1.15, 0.9};
  const MethodOutcome plain = runOn(makeMethod("go-icp"), error, false);
  ASSERT_TRUE(plain.fixed_from_moving.has_value()) << plain.why;
  EXPECT_FALSE(testing::errorsOf(plain, testing::smallPair()).within({}));
  const MethodOutcome helped = runOn(makeMethod("go-icp-oracle-scale"), error, true);
  ASSERT_TRUE(helped.fixed_from_moving.has_value()) << helped.why;
  EXPECT_TRUE(testing::errorsOf(helped, testing::smallPair()).within({}))
      << testing::errorsOf(helped, testing::smallPair()).rms;
}

TEST(GoIcp, FailsOnEmptyMaps) { testing::expectFailsOnEmptyMaps(makeMethod("go-icp")); }

}  // namespace
}  // namespace agricolmap::experiments
