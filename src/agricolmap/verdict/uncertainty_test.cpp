#include "agricolmap/verdict/uncertainty.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/map/test_field.hpp"

namespace agricolmap::verdict {
namespace {

/// Smooth random texture over a map, moved by `shift(point)`.
template <typename Shift>
map::SignalMap texture(const Eigen::Vector2d& corner, int rows, int cols, const Shift& shift) {
  const testing::BumpField field(3, 2500, {Eigen::Vector2d(-1.0, -1.0), Eigen::Vector2d(13.0, 5.0)},
                                 0.06, 0.15);
  return testing::signalOf({corner, 0.04, rows, cols},
                           [&](const Eigen::Vector2d& p) { return field.at(p + shift(p)); });
}

/// Of a strip from x = 1 to 11 m whose points are moved by `bent`, on a map that ends at `end` [m].
template <typename Shift>
PoseUncertainty uncertaintyOf(const Shift& bent, double end) {
  const auto none = [](const Eigen::Vector2d&) { return Eigen::Vector2d(0.0, 0.0); };
  const map::SignalMap fixed = texture({0.0, 0.0}, 100, static_cast<int>(end / 0.04), none);
  const map::SignalMap moving = texture({1.0, 1.0}, 50, 250, bent);
  Evidence evidence;
  evidence.block_side = 1.0;
  const auto found = estimateUncertainty(fixed, moving, Eigen::Affine2d::Identity(), evidence, {},
                                         0.0, 0.005, {.floor = 0.0005});
  EXPECT_TRUE(found.has_value());
  return found.value_or(PoseUncertainty{});
}

PoseUncertainty uncertaintyOf(double bend, double end = 12.0) {
  return uncertaintyOf(
      [&](const Eigen::Vector2d& p) { return Eigen::Vector2d(0.0, bend * std::sin(p.x())); }, end);
}

TEST(Uncertainty, IsSmallWhereTheBlocksAgree) {
  const PoseUncertainty exact = uncertaintyOf(0.0);
  EXPECT_LT(exact.scatter_rms, 0.002);
  EXPECT_LT(exact.expected_rms, 0.003);
  EXPECT_GT(exact.covariance.diagonal().minCoeff(), 0.0);
}

TEST(Uncertainty, GrowsWithWhatNoAffineUndoes) {
  const PoseUncertainty bent = uncertaintyOf(0.03);
  EXPECT_NEAR(bent.scatter_rms, 0.03 / std::sqrt(2.0), 0.012);
  EXPECT_GT(bent.expected_rms, 2.0 * uncertaintyOf(0.0).expected_rms);
  EXPECT_GT(bent.local_rms, 0.6 * bent.scatter_rms) << "neighbours are bent alike";
}

TEST(Uncertainty, WhatEachBlockHasOfItsOwnIsNoDeformation) {
  // Of every square of the blocks' size another shift of 2 cm.
  const auto own = [](const Eigen::Vector2d& p) {
    const double square = std::floor(p.x()) + 10.0 * std::floor(p.y());
    const double direction = 2.4 * square * square;
    return Eigen::Vector2d(0.02 * std::cos(direction), 0.02 * std::sin(direction));
  };
  const PoseUncertainty found = uncertaintyOf(own, 12.0);
  EXPECT_NEAR(found.scatter_rms, 0.02, 0.006);
  EXPECT_LT(found.local_rms, 0.6 * found.scatter_rms);
}

TEST(Uncertainty, APointFarFromTheMiddleIsLessCertain) {
  const PoseUncertainty found = uncertaintyOf(0.02);
  const double middle = found.at(found.centre).trace();
  const double end = found.at(found.centre + Eigen::Vector2d(5.0, 0.0)).trace();
  EXPECT_GT(end, middle);
  // The long direction is known better per metre than the short one.
  EXPECT_LT(found.covariance(3, 3), found.covariance(4, 4));
}

TEST(Uncertainty, GrowsWithWhatLiesBeyondTheMap) {
  const PoseUncertainty half = uncertaintyOf(0.02, 6.0);
  EXPECT_LT(half.centre.x(), 4.0);
  EXPECT_GT(half.expected_rms, 2.0 * uncertaintyOf(0.02).expected_rms);
}

TEST(Uncertainty, TheHeightHangsOnNothingElse) {
  const PoseUncertainty found = uncertaintyOf(0.02);
  const Eigen::Matrix<double, 6, 6> all = found.covarianceWithHeight();
  EXPECT_EQ(all(0, 1), found.covariance(0, 1));
  EXPECT_EQ(all(5, 3), found.covariance(4, 2));
  EXPECT_EQ(all(2, 2), found.height_deviation * found.height_deviation);
  EXPECT_EQ(all.row(2).sum(), all(2, 2));
}

TEST(Uncertainty, GrowsWithPartsThatLieElsewhere) {
  // The last third slipped further than a block looks.
  const auto none = [](const Eigen::Vector2d&) { return Eigen::Vector2d(0.0, 0.0); };
  const auto slipped = [](const Eigen::Vector2d& p) {
    return Eigen::Vector2d(0.0, p.x() > 7.5 ? 0.4 : 0.0);
  };
  const map::SignalMap fixed = texture({0.0, 0.0}, 100, 300, none);
  const map::SignalMap moving = texture({1.0, 1.0}, 50, 250, slipped);
  Evidence evidence;
  evidence.block_side = 1.0;
  evidence.strip = map::stripFrame(moving);
  const auto estimate = [&] {
    return estimateUncertainty(fixed, moving, Eigen::Affine2d::Identity(), evidence, {}, 0.0, 0.005,
                               {});
  };
  const auto blind = estimate();
  ASSERT_TRUE(blind.has_value());
  const bool eastward = evidence.strip.axes(0, 0) > 0.0;
  DisplacedPart part{.begin = 6.5, .end = 10.0, .offset = {0.0, 0.4}};
  if (!eastward) part.begin = 0.0, part.end = 3.5;
  evidence.parts.displaced = {part};
  const auto seeing = estimate();
  ASSERT_TRUE(seeing.has_value());
  EXPECT_GT(seeing->scatter_rms, 0.1);
  EXPECT_LT(blind->scatter_rms, 0.05);
  EXPECT_GT(seeing->expected_rms, 2.0 * blind->expected_rms);
}

TEST(Uncertainty, NeedsBlocks) {
  const auto none = [](const Eigen::Vector2d&) { return Eigen::Vector2d(0.0, 0.0); };
  const map::SignalMap fixed = texture({0.0, 0.0}, 60, 60, none);
  const map::SignalMap moving = texture({0.5, 0.5}, 20, 20, none);
  Evidence evidence;
  EXPECT_FALSE(
      estimateUncertainty(fixed, moving, Eigen::Affine2d::Identity(), evidence, {}, 0.0, 0.0, {}));
  evidence.block_side = 1.0;
  EXPECT_FALSE(
      estimateUncertainty(fixed, moving, Eigen::Affine2d::Identity(), evidence, {}, 0.0, 0.0, {}));
}

TEST(DoubtOfBend, IsThatOfWhatTheBendLeaves) {
  PoseUncertainty bent, straight;
  bent.scatter_rms = 0.04;
  straight.scatter_rms = 0.01;  // drift of dead reckoning, and little else
  EXPECT_DOUBLE_EQ(doubtOfBend(0.03, bent, straight), 0.0075);
  straight.scatter_rms = 0.035;  // plants that grew
  EXPECT_GT(doubtOfBend(0.03, bent, straight), 0.025);
  straight.scatter_rms = 0.05;
  EXPECT_DOUBLE_EQ(doubtOfBend(0.03, bent, straight), 0.03);
  bent.scatter_rms = 0.0;
  EXPECT_EQ(doubtOfBend(0.03, bent, straight), 0.0);
}

}  // namespace
}  // namespace agricolmap::verdict
