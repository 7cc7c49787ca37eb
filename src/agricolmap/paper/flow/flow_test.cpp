#include <gtest/gtest.h>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/map/test_field.hpp"
#include "agricolmap/map/warp.hpp"
#include "agricolmap/paper/flow_association.hpp"

namespace agricolmap::paper {
namespace {

using testing::guessError;
using testing::TestField;
using testing::Truth;
using testing::viewOf;

const Eigen::Vector2d kCentre(6.0, 6.0);

map::Box2 box(double x0, double y0, double x1, double y1) {
  return {Eigen::Vector2d(x0, y0), Eigen::Vector2d(x1, y1)};
}

/// A 12 m field of single plants; half of the leaves differ between the views.
struct Scene {
  map::GridMap fixed;
  map::GridMap moving;
  SearchSpace space;
};

Scene sceneOf(const Eigen::Affine2d& pose, const PriorUncertainty& uncertainty) {
  TestField field;
  field.size = 12.0;
  field.other_leaves = 0.5;
  field.noise = 0.1;
  const Truth above = growField(field);
  field.leaf_seed = 2;
  const Truth beside = growField(field);
  Scene scene;
  scene.fixed = viewOf(above, field, box(0, 0, 12, 12), Eigen::Affine2d::Identity(), 0.05, 11);
  scene.moving = viewOf(beside, field, box(3.5, 5.0, 8.5, 7.0), pose, 0.1, 12);
  scene.space.uncertainty = uncertainty;
  scene.space.centre = kCentre;
  return scene;
}

double shareRight(const std::vector<Match>& matches, const Eigen::Affine2d& pose, double limit) {
  double right = 0.0;
  for (const Match& m : matches) right += (pose * m.moving - m.fixed).norm() <= limit ? 1.0 : 0.0;
  return matches.empty() ? 0.0 : right / static_cast<double>(matches.size());
}

FlowAssociationOptions plainOptions() {
  FlowAssociationOptions options;
  options.warps = false;
  options.rematch = false;
  return options;
}

TEST(Flow, FindsShiftAsThePaperDoes) {
  const Eigen::Affine2d pose = guessError(kCentre, {2.0, -1.5}, 0.0, 1.0, 1.0);
  const Scene scene = sceneOf(pose, {.translation = 3.0, .heading_deg = 5.0, .scale = 0.1});
  Monitor monitor;
  const auto result =
      associateByFlow(scene.fixed, scene.moving, scene.space, plainOptions(), monitor);
  ASSERT_FALSE(result.placements.empty());
  EXPECT_GT(result.matches.size(), 800U);
  EXPECT_GT(shareRight(result.matches, pose, 0.1), 0.7);
  EXPECT_GT(shareRight(result.placements.front().matches, pose, 0.1), 0.98);
  EXPECT_GT(result.report.seeds, result.matches.size() / 2);
  EXPECT_EQ(result.report.first.matches, result.matches.size());
  EXPECT_EQ(result.report.first.inliers, result.placements.front().matches.size());
  EXPECT_FALSE(result.report.again);
  ASSERT_EQ(monitor.times().size(), 3U);
  EXPECT_EQ(monitor.times()[0].stage, Stage::kDescribe);
  EXPECT_EQ(monitor.times()[1].stage, Stage::kFlow);
  EXPECT_EQ(monitor.times()[2].stage, Stage::kVote);
}

/// What the literal preset sets.
FlowAssociationOptions literalOptions() {
  FlowAssociationOptions options = plainOptions();
  options.describe.empty = EmptyCells::kZero;
  options.describe.daisy.norm = DaisyNorm::kPartial;
  options.describe.daisy.shrink = 1.0;
  options.describe.fpfh.exaggeration = 1.0;
  options.cost.normalise = false;
  options.vote.kind = VoteKind::kDisplacement;
  return options;
}

TEST(Flow, LiteralFindsShiftAndLosesATurnedStrip) {
  const PriorUncertainty uncertainty{.translation = 3.0, .heading_deg = 5.0, .scale = 0.1};
  const auto bestOf = [&](double yaw) {
    const Eigen::Affine2d pose = guessError(kCentre, {2.0, -1.5}, yaw, 1.0, 1.0);
    const Scene scene = sceneOf(pose, uncertainty);
    Monitor monitor;
    const auto result =
        associateByFlow(scene.fixed, scene.moving, scene.space, literalOptions(), monitor);
    if (result.placements.empty()) return std::pair{0.0, 0.0};
    const std::vector<Match>& best = result.placements.front().matches;
    return std::pair{shareRight(best, pose, 0.1), static_cast<double>(best.size())};
  };
  const auto [right, straight] = bestOf(0.0);
  EXPECT_GT(right, 0.98);
  // 5 m long and turned by 0.08 rad its displacements spread over 40 cm.
  EXPECT_LT(bestOf(0.08).second, 0.5 * straight);
}

TEST(Flow, FindsAffineWithWarpsAndRematch) {
  const Eigen::Affine2d pose = guessError(kCentre, {-1.5, 1.0}, 0.2, 0.75, 1.25);
  const Scene scene = sceneOf(pose, {.translation = 2.5, .heading_deg = 11.5, .scale = 0.3});
  Monitor monitor;
  const auto result = associateByFlow(scene.fixed, scene.moving, scene.space, {}, monitor);
  ASSERT_FALSE(result.placements.empty());
  const Placement& best = result.placements.front();
  EXPECT_GT(shareRight(best.matches, pose, 0.1), 0.98);
  const auto fit = fitScaledRotation(best.matches, {}, scene.space.scale_axes);
  ASSERT_TRUE(fit);
  for (const double x : {3.5, 8.5}) {
    for (const double y : {5.0, 7.0}) {
      const Eigen::Vector2d corner(x, y);
      EXPECT_LT((fit->fixed_from_moving * corner - pose * corner).norm(), 0.05);
    }
  }
  for (std::size_t k = 1; k < result.placements.size(); ++k) {
    EXPECT_LT(result.placements[k].score, 0.5 * best.score);
  }
}

TEST(Flow, SameOnAnyNumberOfThreads) {
  const Eigen::Affine2d pose = guessError(kCentre, {0.5, -0.4}, 0.05, 1.05, 0.95);
  const Scene scene = sceneOf(pose, {.translation = 1.0, .heading_deg = 4.0, .scale = 0.1});
  const auto run = [&](int seed) {
    FlowAssociationOptions options;
    options.seed = seed;
    Monitor monitor;
    return associateByFlow(scene.fixed, scene.moving, scene.space, options, monitor);
  };
  const auto same = [](const FlowResult& a, const FlowResult& b) {
    return a.matches.size() == b.matches.size() &&
           std::equal(a.matches.begin(), a.matches.end(), b.matches.begin(),
                      [](const Match& m, const Match& n) {
                        return m.moving == n.moving && m.fixed == n.fixed;
                      });
  };
  const auto parallel = run(1);
  const ThreadLimit limit(1);
  EXPECT_TRUE(same(run(1), parallel));
  EXPECT_FALSE(same(run(2), parallel));
}

TEST(Flow, NothingWhereTheMapsDoNotMeet) {
  Scene scene = sceneOf(Eigen::Affine2d::Identity(), {.translation = 1.0});
  scene.moving.frame.corner += Eigen::Vector2d(100.0, 0.0);
  scene.space.centre += Eigen::Vector2d(100.0, 0.0);
  Monitor monitor;
  const auto result = associateByFlow(scene.fixed, scene.moving, scene.space, {}, monitor);
  EXPECT_TRUE(result.placements.empty());
  EXPECT_EQ(result.report.first.inliers, 0U);
}

TEST(Reach, SamplesStayInTheBoxes) {
  SearchSpace space;
  space.centre = {10.0, 5.0};
  space.scale_axes = rotation2(0.4);
  const Reach reach(space);
  Random random(1);
  for (const Eigen::Vector2d& q : {Eigen::Vector2d(10.0, 5.0), Eigen::Vector2d(15.0, 4.0)}) {
    map::Box2 seen;
    const map::Box2 forward = reach.forwardBox(q);
    for (int k = 0; k < 2000; ++k) {
      const Eigen::Vector2d p = reach.sampleForward(q, random);
      seen.extend(p);
      EXPECT_LT(forward.exteriorDistance(p), 0.02);
      EXPECT_LT(reach.backwardBox(p).exteriorDistance(q), 0.02);
      EXPECT_LT(reach.backwardBox(q).exteriorDistance(reach.sampleBackward(q, random)), 0.02);
    }
    // Farther from the centre heading and scales reach farther.
    EXPECT_GT(seen.sizes().minCoeff(), 0.8 * forward.sizes().minCoeff());
  }
  EXPECT_GT(reach.forwardBox({15.0, 4.0}).sizes().x(), reach.forwardBox({10.0, 5.0}).sizes().x());
}

TEST(MatchCost, ComparesKnownPointsOnly) {
  DescriptorMap fixed;
  fixed.frame = {Eigen::Vector2d::Zero(), 0.02, 1, 1};
  fixed.bytes.assign(DescriptorMap::kStride, 0);
  fixed.known = {DescriptorMap::kDaisyBits | DescriptorMap::kFpfhBit};
  DescriptorMap moving = fixed;
  for (int k = 0; k < kDaisySize; ++k) fixed.bytes[static_cast<std::size_t>(k)] = 33;
  const CostOptions options;
  // A single pair of cells has no spread: the cost is in bytes.
  EXPECT_NEAR(MatchCost(fixed, moving, options)(0, 0), 33.0F, 1e-3F);
  // Half of the points say the same, the others are unknown.
  for (std::size_t k = 0; k < kDaisySize / 2; ++k) moving.bytes[k] = 33;
  moving.known = {0x00FFU | DescriptorMap::kFpfhBit};
  EXPECT_EQ(MatchCost(fixed, moving, options)(0, 0), 0.0F);
  moving.bytes[DescriptorMap::kFpfhOffset + 32] = 200;
  EXPECT_GT(MatchCost(fixed, moving, options)(0, 0), 0.0F);
  moving.known = {0x0003U};
  EXPECT_EQ(MatchCost(fixed, moving, options)(0, 0), MatchCost::kImpossible);
}

TEST(MatchCost, PlainIsThePapersSumOfAbsoluteDifferences) {
  DescriptorMap fixed;
  fixed.frame = {Eigen::Vector2d::Zero(), 0.02, 1, 2};
  fixed.bytes.assign(2UL * DescriptorMap::kStride, 0);
  fixed.known.assign(2, DescriptorMap::kDaisyBits | DescriptorMap::kFpfhBit);
  DescriptorMap moving = fixed;
  double daisy = 0.0;
  double fpfh = 0.0;
  for (int k = 0; k < kDaisySize + kFpfhSize; ++k) {
    const int a = 3 * k % 256;
    const int b = 7 * k % 256;
    // The second cell of the fixed map.
    fixed.bytes[static_cast<std::size_t>(DescriptorMap::kStride + k)] =
        static_cast<std::uint8_t>(a);
    moving.bytes[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(b);
    (k < kDaisySize ? daisy : fpfh) += std::abs(a - b);
  }
  const CostOptions options{.alpha = 1.0, .beta = 0.5, .normalise = false};
  EXPECT_FLOAT_EQ(MatchCost(fixed, moving, options)(1, 0), static_cast<float>(daisy + 0.5 * fpfh));
  const CostOptions other{.alpha = 2.0, .beta = 0.0, .normalise = false};
  EXPECT_FLOAT_EQ(MatchCost(fixed, moving, other)(1, 0), static_cast<float>(2.0 * daisy));
  // Half of the points speak for all.
  double half = 0.0;
  for (int k = 0; k < kDaisySize / 2; ++k) half += std::abs(3 * k % 256 - 7 * k % 256);
  moving.known[0] = 0x00FFU;
  EXPECT_FLOAT_EQ(MatchCost(fixed, moving, options)(1, 0), static_cast<float>(2.0 * half));
}

/// A map of random descriptors, with bytes below the limits.
DescriptorMap randomMap(std::uint64_t seed, int daisy, int fpfh) {
  DescriptorMap map;
  map.frame = {Eigen::Vector2d::Zero(), 0.02, 20, 20};
  map.known.assign(400, DescriptorMap::kDaisyBits | DescriptorMap::kFpfhBit);
  map.bytes.assign(400UL * DescriptorMap::kStride, 0);
  Random random(seed);
  for (std::size_t cell = 0; cell < map.known.size(); ++cell) {
    // Contrast differs from cell to cell, so that differences do.
    const double strength = random.uniform();
    for (int k = 0; k < kDaisySize + kFpfhSize; ++k) {
      const int limit = k < kDaisySize ? daisy : fpfh;
      map.bytes[cell * DescriptorMap::kStride + static_cast<std::size_t>(k)] =
          static_cast<std::uint8_t>(std::lround(strength * random.uniform() * limit));
    }
  }
  return map;
}

TEST(MatchCost, WeighsEachDescriptorByItsOwnSpread) {
  const auto costs = [](int daisy, int fpfh, const CostOptions& options) {
    const DescriptorMap fixed = randomMap(1, daisy, fpfh);
    const DescriptorMap moving = randomMap(2, daisy, fpfh);
    const MatchCost cost(fixed, moving, options);
    std::vector<double> result;
    for (std::size_t k = 0; k < 400; ++k) result.push_back(cost(k, 399 - k));
    return result;
  };
  const auto deviation = [](const std::vector<double>& values) {
    double mean = 0.0;
    double squares = 0.0;
    for (const double v : values) mean += v / static_cast<double>(values.size());
    for (const double v : values) squares += (v - mean) * (v - mean);
    return std::sqrt(squares / static_cast<double>(values.size()));
  };
  EXPECT_NEAR(deviation(costs(200, 60, {.alpha = 1.0, .beta = 0.0})), 1.0, 0.1);
  EXPECT_NEAR(deviation(costs(200, 60, {.alpha = 0.0, .beta = 0.5})), 0.5, 0.05);
  // However strong the one descriptor's contrast, it weighs as much beside the other.
  const std::vector<double> weak = costs(200, 60, {});
  const std::vector<double> strong = costs(200, 240, {});
  for (std::size_t k = 0; k < weak.size(); ++k) EXPECT_NEAR(weak[k], strong[k], 0.1);
}

TEST(Warp, MovesWhatTheMapShows) {
  const Scene scene = sceneOf(Eigen::Affine2d::Identity(), {});
  const Eigen::Affine2d warp = guessError(kCentre, {0.3, 0.1}, 0.2, 1.1, 0.9);
  const map::GridMap map = map::warped(scene.moving, warp);
  double difference = 0.0;
  int cells = 0;
  for (const double x : {4.01, 5.03, 6.21, 7.35, 8.01}) {
    const Eigen::Vector2d there = map.frame.cellOf(warp * Eigen::Vector2d(x, 6.01));
    const Eigen::Vector2d here = scene.moving.frame.cellOf(Eigen::Vector2d(x, 6.01));
    const int row = static_cast<int>(std::lround(there.y()));
    const int col = static_cast<int>(std::lround(there.x()));
    ASSERT_TRUE(map.weight.contains(row, col));
    const int from_row = static_cast<int>(std::lround(here.y()));
    const int from_col = static_cast<int>(std::lround(here.x()));
    if (!map.valid(row, col) || !scene.moving.valid(from_row, from_col)) continue;
    difference +=
        static_cast<double>(std::abs(map.exg(row, col) - scene.moving.exg(from_row, from_col)));
    ++cells;
  }
  ASSERT_GE(cells, 3);
  EXPECT_LT(difference / cells, 0.25);
  EXPECT_NEAR(static_cast<double>(map.filled), 0.99 * static_cast<double>(scene.moving.filled),
              0.05 * static_cast<double>(map.filled));
}

}  // namespace
}  // namespace agricolmap::paper
