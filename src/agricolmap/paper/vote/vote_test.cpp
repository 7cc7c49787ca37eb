#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/paper/vote/coherent_vote.hpp"

namespace agricolmap::paper {
namespace {

constexpr double kCell = 0.02;

struct Flow {
  std::vector<Match> matches;
  std::vector<bool> right;
};

/// A flow over a 10 × 2.2 m strip: true matches with 1 cell of noise, the others anywhere in reach.
Flow stripFlow(const Eigen::Affine2d& pose, double outliers, std::uint64_t seed) {
  Random random(seed);
  Flow flow;
  for (double x = 0.0; x < 10.0; x += 0.06) {
    for (double y = 0.0; y < 2.2; y += 0.06) {
      const Eigen::Vector2d q(x, y);
      const bool right = !random.chance(outliers);
      const Eigen::Vector2d p =
          right ? Eigen::Vector2d(pose * q +
                                  Eigen::Vector2d(random.normal(kCell), random.normal(kCell)))
                : Eigen::Vector2d(
                      q + Eigen::Vector2d(random.uniform(-6.5, 6.5), random.uniform(-6.5, 6.5)));
      flow.matches.push_back({q, p});
      flow.right.push_back(right);
    }
  }
  return flow;
}

Eigen::Affine2d poseOf(double yaw_deg, double sx, double sy, const Eigen::Matrix2d& axes) {
  const Eigen::Vector2d centre(5.0, 1.1);
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  pose.linear() =
      rotation2(radians(yaw_deg)) * axes * Eigen::Vector2d(sx, sy).asDiagonal() * axes.transpose();
  pose.translation() = centre + Eigen::Vector2d(3.0, -3.9) - pose.linear() * centre;
  return pose;
}

SearchSpace paperSpace() {
  SearchSpace space;
  space.centre = {5.0, 1.1};
  return space;
}

TEST(CoherentVote, KeepsWholeStripUnderPaperErrors) {
  for (const double sign : {-1.0, 1.0}) {
    for (const double outliers : {0.6, 0.85, 0.9}) {
      const Eigen::Affine2d pose =
          poseOf(11.5 * sign, 1.0 + 0.3 * sign, 1.0 - 0.3 * sign, Eigen::Matrix2d::Identity());
      const Flow flow = stripFlow(pose, outliers, 7);
      const auto placements = voteCoherent(flow.matches, paperSpace(), kCell, {});
      ASSERT_FALSE(placements.empty());
      const VotedPlacement& best = placements.front();
      double kept = 0.0;
      for (const std::uint32_t i : best.inliers) kept += flow.right[i] ? 1.0 : 0.0;
      const auto all = static_cast<double>(std::count(flow.right.begin(), flow.right.end(), true));
      EXPECT_GE(kept, 0.9 * all);
      EXPECT_GE(kept, 0.97 * static_cast<double>(best.inliers.size()));
      EXPECT_NEAR(best.pose.yaw, sign * radians(11.5), 2e-3);
      EXPECT_NEAR(best.pose.scale.x(), 1.0 + 0.3 * sign, 2e-3);
      EXPECT_NEAR(best.pose.scale.y(), 1.0 - 0.3 * sign, 1e-2);
    }
  }
}

TEST(CoherentVote, ScalesActAlongTheGivenAxes) {
  SearchSpace space = paperSpace();
  space.scale_axes = rotation2(0.5);
  const Eigen::Affine2d pose = poseOf(-5.0, 1.25, 0.8, space.scale_axes);
  const Flow flow = stripFlow(pose, 0.8, 3);
  const auto placements = voteCoherent(flow.matches, space, kCell, {});
  ASSERT_FALSE(placements.empty());
  EXPECT_NEAR(placements.front().pose.scale.x(), 1.25, 5e-3);
  EXPECT_NEAR(placements.front().pose.scale.y(), 0.8, 5e-3);
}

TEST(CoherentVote, ReturnsDistinctPlacementsBestFirst) {
  const Eigen::Affine2d pose = poseOf(3.0, 1.1, 0.9, Eigen::Matrix2d::Identity());
  Flow flow = stripFlow(pose, 0.0, 5);
  Random random(9);
  for (Match& match : flow.matches) {
    const double draw = random.uniform();
    if (draw < 0.3) match.fixed += Eigen::Vector2d(0.0, 0.5);  // one row off
    if (draw > 0.8) match.fixed += Eigen::Vector2d(1.0, 0.0);  // five plants off
  }
  const auto placements = voteCoherent(flow.matches, paperSpace(), kCell, {});
  ASSERT_EQ(placements.size(), 3U);
  EXPECT_GT(placements[0].inliers.size(), placements[1].inliers.size());
  EXPECT_GT(placements[1].inliers.size(), placements[2].inliers.size());
  const Eigen::Vector2d centre(5.0, 1.1);
  const Eigen::Vector2d off =
      placements[1].pose.fixed_from_moving * centre - placements[0].pose.fixed_from_moving * centre;
  EXPECT_NEAR(off.y(), 0.5, 0.02);
}

TEST(CoherentVote, FindsNothingInNoiseAndNothingInNothing) {
  EXPECT_TRUE(voteCoherent({}, paperSpace(), kCell, {}).empty());
  const Flow noise = stripFlow(Eigen::Affine2d::Identity(), 1.0, 2);
  for (const auto& placement : voteCoherent(noise.matches, paperSpace(), kCell, {})) {
    EXPECT_LT(placement.inliers.size(), noise.matches.size() / 100);
  }
}

VoteOptions displacementOptions() {
  VoteOptions options;
  options.kind = VoteKind::kDisplacement;
  return options;
}

TEST(DisplacementVote, CollectsThePureShiftAlone) {
  std::vector<Match> matches;
  Random random(3);
  for (int i = 0; i < 600; ++i) {
    const Eigen::Vector2d q(random.uniform(0.0, 10.0), random.uniform(0.0, 2.2));
    // Two thirds in the middle of one bin, a sixth one row beside it, the others anywhere.
    Eigen::Vector2d d(1.01, -0.53);
    if (i % 6 == 1) d.y() += 0.5;
    if (i % 6 == 2) d = {random.uniform(-6.0, 6.0), random.uniform(-6.0, 6.0)};
    d += Eigen::Vector2d(random.uniform(-0.009, 0.009), random.uniform(-0.009, 0.009));
    matches.push_back({q, q + d});
  }
  const auto placements = voteCoherent(matches, paperSpace(), kCell, displacementOptions());
  ASSERT_EQ(placements.size(), 2U);
  ASSERT_EQ(placements[0].inliers.size(), 400U);
  for (const std::uint32_t i : placements[0].inliers) EXPECT_TRUE(i % 6 == 0 || i % 6 > 2);
  EXPECT_EQ(placements[1].inliers.size(), 100U);
  EXPECT_NEAR(placements[0].pose.yaw, 0.0, 1e-3);
  const Eigen::Vector2d centre(5.0, 1.1);
  const Eigen::Vector2d moved = placements[0].pose.fixed_from_moving * centre - centre;
  EXPECT_NEAR((moved - Eigen::Vector2d(1.01, -0.53)).norm(), 0.0, 2e-3);
}

TEST(DisplacementVote, LosesATurnedStripThatPosesKeep) {
  const Eigen::Affine2d pose = poseOf(5.0, 1.0, 1.0, Eigen::Matrix2d::Identity());
  const Flow flow = stripFlow(pose, 0.0, 7);
  const auto poses = voteCoherent(flow.matches, paperSpace(), kCell, {});
  ASSERT_FALSE(poses.empty());
  EXPECT_GT(static_cast<double>(poses.front().inliers.size()),
            0.9 * static_cast<double>(flow.matches.size()));
  // Over 10 m the displacement varies by 87 cm, so a bin of 2 cm holds what lies on a short band.
  const auto bins = voteCoherent(flow.matches, paperSpace(), kCell, displacementOptions());
  ASSERT_FALSE(bins.empty());
  EXPECT_LT(static_cast<double>(bins.front().inliers.size()),
            0.02 * static_cast<double>(flow.matches.size()));
}

TEST(DisplacementVote, NeighbouringBinsAreOnePlacementAndALineHasAShift) {
  std::vector<Match> matches;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d q(0.1 * i, 1.0);
    matches.push_back({q, q + Eigen::Vector2d(i < 60 ? 0.31 : 0.33, 0.01)});
  }
  const auto placements = voteCoherent(matches, paperSpace(), kCell, displacementOptions());
  ASSERT_EQ(placements.size(), 1U);
  EXPECT_EQ(placements[0].inliers.size(), 60U);
  EXPECT_NEAR(placements[0].pose.fixed_from_moving.translation().x(), 0.31, 1e-12);
  EXPECT_TRUE(voteCoherent({}, paperSpace(), kCell, displacementOptions()).empty());
}

TEST(CoherentVote, SameOnAnyNumberOfThreads) {
  const Flow flow = stripFlow(poseOf(8.0, 0.8, 1.2, Eigen::Matrix2d::Identity()), 0.85, 4);
  const auto parallel = voteCoherent(flow.matches, paperSpace(), kCell, {});
  const ThreadLimit limit(1);
  const auto serial = voteCoherent(flow.matches, paperSpace(), kCell, {});
  ASSERT_EQ(parallel.size(), serial.size());
  for (std::size_t k = 0; k < serial.size(); ++k) {
    EXPECT_EQ(parallel[k].inliers, serial[k].inliers);
  }
}

}  // namespace
}  // namespace agricolmap::paper
