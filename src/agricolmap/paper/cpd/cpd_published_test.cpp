#include "agricolmap/paper/cpd/cpd_published.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::paper {
namespace {

/// Plants in rows on a gently rolling strip, at coordinates as levelled maps have them.
Eigen::Matrix3Xd plants(Eigen::Index count, std::uint64_t seed) {
  Random random(seed);
  Eigen::Matrix3Xd points(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    points.col(i) << 40.0 + random.uniform(0.0, 6.0),
        20.0 + 0.5 * std::floor(random.uniform(0.0, 4.0)) + random.normal(0.03),
        random.uniform(0.0, 0.2);
  }
  return points;
}

/// The article's affine algorithm word by word: the matrix P of all posteriors, then B, t and σ²
/// from it.
PublishedCpdState referenceStep(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& y,
                                const PublishedCpdState& state, double w) {
  const Eigen::Index n = x.cols();
  const Eigen::Index m = y.cols();
  Eigen::MatrixXd p(m, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index i = 0; i < m; ++i) {
      const Eigen::Vector3d moved = state.linear * y.col(i) + state.shift;
      p(i, j) = std::exp(-(x.col(j) - moved).squaredNorm() / (2.0 * state.variance));
    }
    p.col(j) /= p.col(j).sum() + std::pow(2.0 * std::numbers::pi * state.variance, 1.5) * w /
                                     (1.0 - w) * static_cast<double>(m) / static_cast<double>(n);
  }
  const Eigen::VectorXd p1 = p.rowwise().sum();
  const Eigen::VectorXd pt1 = p.colwise().sum();
  PublishedCpdState next;
  next.matched = p.sum();
  const Eigen::Vector3d mean_x = x * pt1 / next.matched;
  const Eigen::Vector3d mean_y = y * p1 / next.matched;
  const Eigen::MatrixXd xc = (x.colwise() - mean_x).transpose();
  const Eigen::MatrixXd yc = (y.colwise() - mean_y).transpose();
  const Eigen::MatrixXd cross = xc.transpose() * p.transpose() * yc;
  next.linear = cross * (yc.transpose() * p1.asDiagonal() * yc).inverse();
  next.shift = mean_x - next.linear * mean_y;
  next.variance = ((xc.transpose() * pt1.asDiagonal() * xc).trace() -
                   (cross * next.linear.transpose()).trace()) /
                  (3.0 * next.matched);
  return next;
}

TEST(PublishedCpd, StepsAsTheArticleDoes) {
  const Eigen::Matrix3Xd fixed = plants(70, 1);
  const Eigen::Matrix3Xd moving = plants(50, 2);
  PublishedCpdState state;
  double all_pairs = 0.0;
  for (Eigen::Index i = 0; i < 70; ++i) {
    all_pairs += (moving.colwise() - fixed.col(i)).squaredNorm();
  }
  state.variance = publishedCpdVariance(fixed, moving);
  EXPECT_NEAR(state.variance, all_pairs / (3.0 * 70.0 * 50.0), 1e-9);
  for (int i = 0; i < 20; ++i) {
    const PublishedCpdState expected = referenceStep(fixed, moving, state, 0.3);
    state = publishedCpdStep(fixed, moving, state, 0.3);
    ASSERT_FALSE(state.degenerate);
    EXPECT_NEAR(state.matched, expected.matched, 1e-3);
    EXPECT_NEAR(state.variance, expected.variance, 1e-4 * expected.variance);
    const Eigen::Matrix3Xd apart =
        ((state.linear - expected.linear) * moving).colwise() + (state.shift - expected.shift);
    EXPECT_LT(apart.colwise().norm().maxCoeff(), 1e-3) << i;
  }
}

TEST(PublishedCpd, FindsAnAffineMapFromNear) {
  const Eigen::Matrix3Xd moving = plants(400, 3);
  Eigen::Affine3d truth = Eigen::Affine3d::Identity();
  truth.linear() = Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                   Eigen::Vector3d(1.03, 0.98, 1.0).asDiagonal();
  const Eigen::Vector3d middle = moving.rowwise().mean();
  truth.translation() = middle + Eigen::Vector3d(0.05, -0.04, 0.02) - truth.linear() * middle;
  const Eigen::Matrix3Xd fixed = truth * moving;
  PublishedCpdOptions options;
  options.max_iterations = 1000;
  const PublishedCpdResult result = publishedCpd(fixed, moving, options);
  EXPECT_TRUE(result.converged);
  const Eigen::Matrix3Xd found = (result.state.linear * moving).colwise() + result.state.shift;
  EXPECT_LT((found - fixed).colwise().norm().maxCoeff(), 1e-3);
}

TEST(PublishedCpd, PointsInAPlaneAreDegenerateAndThreadsAlike) {
  Eigen::Matrix3Xd flat = plants(100, 4);
  flat.row(2).setConstant(1.0);
  const PublishedCpdResult result = publishedCpd(flat, flat, {});
  EXPECT_TRUE(result.state.degenerate);
  EXPECT_EQ(result.iterations, 1);
  EXPECT_TRUE(result.state.linear.isIdentity());

  const Eigen::Matrix3Xd fixed = plants(600, 5);
  const Eigen::Matrix3Xd moving = plants(500, 6);
  PublishedCpdOptions few;
  few.max_iterations = 10;
  const PublishedCpdResult all = publishedCpd(fixed, moving, few);
  EXPECT_FALSE(all.converged);
  EXPECT_EQ(all.iterations, 10);
  const ThreadLimit limit(1);
  const PublishedCpdResult one = publishedCpd(fixed, moving, few);
  EXPECT_EQ(one.state.linear, all.state.linear);
  EXPECT_EQ(one.state.variance, all.state.variance);
  PublishedCpdOptions bad;
  bad.outlier_share = 1.0;
  EXPECT_THROW(publishedCpd(fixed, moving, bad), UsageError);
}

}  // namespace
}  // namespace agricolmap::paper
