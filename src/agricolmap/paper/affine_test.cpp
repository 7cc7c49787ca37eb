#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/scaled_rotation.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/paper/estimate_affine.hpp"

namespace agricolmap::paper {
namespace {

/// R(yaw)·A·diag(scale)·Aᵀ with a shift.
Eigen::Affine2d poseOf(double yaw, double sx, double sy, const Eigen::Matrix2d& axes) {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  pose.linear() = YawScales{yaw, {sx, sy}}.linear(axes);
  pose.translation() = Eigen::Vector2d(3.0, -7.0);
  return pose;
}

/// Points of a 10 × 2 m strip, moved, with normal noise and a share of points moved elsewhere.
std::vector<Match> stripMatches(const Eigen::Affine2d& pose, std::size_t count, double noise,
                                double outliers, std::uint64_t seed) {
  Random random(seed);
  std::vector<Match> matches;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d q(random.uniform(100.0, 110.0), random.uniform(50.0, 52.0));
    Eigen::Vector2d p = pose * q;
    if (random.chance(outliers)) {
      p += Eigen::Vector2d(random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0));
    } else if (noise > 0.0) {
      p += Eigen::Vector2d(random.normal(noise), random.normal(noise));
    }
    matches.push_back({q, p});
  }
  return matches;
}

/// Largest displacement between two maps over the strip [m].
double gap(const Eigen::Affine2d& a, const Eigen::Affine2d& b) {
  return poseDistance(cornersOf({Eigen::Vector2d(100.0, 50.0), Eigen::Vector2d(110.0, 52.0)}), a,
                      b);
}

TEST(EstimateAffine, RecoversExactMaps) {
  for (const double turn : {0.0, 0.4, -2.0}) {
    for (const double yaw : {-3.0, -0.2, 0.0, 0.2, 2.5}) {
      const Eigen::Matrix2d axes = rotation2(turn);
      const Eigen::Affine2d truth = poseOf(yaw, 1.3, 0.7, axes);
      const auto estimate = estimateAffine(stripMatches(truth, 50, 0.0, 0.0, 1), axes, {});
      ASSERT_TRUE(estimate.ok());
      EXPECT_LT(gap(estimate.fixed_from_moving, truth), 1e-9);
    }
  }
}

TEST(EstimateAffine, ClosedFormBeatsEveryNeighbour) {
  const Eigen::Matrix2d axes = rotation2(0.3);
  const auto matches = stripMatches(poseOf(0.1, 1.1, 0.9, axes), 60, 0.3, 0.0, 5);
  const auto cost = [&](const Eigen::Affine2d& pose) {
    double sum = 0.0;
    for (const Match& m : matches) sum += (m.fixed - pose * m.moving).squaredNorm();
    return sum;
  };
  const auto fit = fitScaledRotation(matches, {}, axes);
  ASSERT_TRUE(fit);
  const double best = cost(fit->fixed_from_moving);
  const Eigen::Vector2d middle(105.0, 51.0);
  for (const double yaw : {-1e-3, 0.0, 1e-3}) {
    for (const double sx : {-1e-3, 0.0, 1e-3}) {
      for (const double sy : {-1e-3, 0.0, 1e-3}) {
        Eigen::Affine2d pose =
            poseOf(fit->yaw + yaw, fit->scale.x() + sx, fit->scale.y() + sy, axes);
        pose.translation() = fit->fixed_from_moving * middle - pose.linear() * middle;
        EXPECT_GE(cost(pose), best - 1e-9);
      }
    }
  }
}

TEST(EstimateAffine, WithstandsOutliersAndNoise) {
  const Eigen::Affine2d truth = poseOf(0.2, 1.3, 0.7, Eigen::Matrix2d::Identity());
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    const auto matches = stripMatches(truth, 2000, 0.03, 0.4, seed);
    const auto estimate = estimateAffine(matches, Eigen::Matrix2d::Identity(), {});
    ASSERT_TRUE(estimate.ok());
    EXPECT_LT(gap(estimate.fixed_from_moving, truth), 0.015);
  }
}

TEST(EstimateAffine, PlainLeastSquaresIsThePapers) {
  AffineOptions options;
  options.robust = false;
  const Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();
  const Eigen::Affine2d truth = poseOf(0.2, 1.3, 0.7, axes);
  const auto matches = stripMatches(truth, 2000, 0.03, 0.2, 2);
  const auto plain = estimateAffine(matches, axes, options);
  ASSERT_TRUE(plain.ok());
  EXPECT_TRUE(plain.fixed_from_moving.isApprox(
      fitScaledRotation(matches, {}, axes)->fixed_from_moving, 1e-12));
  // Every outlier has its say.
  EXPECT_GT(gap(plain.fixed_from_moving, truth),
            5.0 * gap(estimateAffine(matches, axes, {}).fixed_from_moving, truth));
}

TEST(EstimateAffine, NamesWhatIsMissing) {
  const Eigen::Matrix2d axes = Eigen::Matrix2d::Identity();
  const Eigen::Affine2d truth = poseOf(0.0, 1.0, 1.0, axes);
  const auto few = estimateAffine(stripMatches(truth, 5, 0.0, 0.0, 1), axes, {});
  EXPECT_EQ(few.status, AffineStatus::kTooFewMatches);
  EXPECT_TRUE(few.fixed_from_moving.matrix().array().isNaN().all());

  std::vector<Match> line;
  std::vector<Match> spot;
  std::vector<Match> mirrored;
  for (int k = 0; k < 40; ++k) {
    line.push_back({Eigen::Vector2d(k, 0.0), Eigen::Vector2d(k, 1.0)});
    spot.push_back({Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(1.0, 2.0)});
    const Eigen::Vector2d q(k % 8, k / 8);
    mirrored.push_back({q, Eigen::Vector2d(q.x(), -q.y())});
  }
  for (const auto& matches : {line, spot, mirrored}) {
    const auto estimate = estimateAffine(matches, axes, {});
    EXPECT_EQ(estimate.status, AffineStatus::kDegenerate);
    EXPECT_TRUE(estimate.fixed_from_moving.matrix().array().isNaN().all());
  }
}

}  // namespace
}  // namespace agricolmap::paper
