#include "agricolmap/6_refine/block_refine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "agricolmap/6_refine/dense_refine.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap {
namespace {

constexpr double kCell = 0.04;

/// Plants in rows with odd gaps.
class Field {
 public:
  Field() {
    Random random(5);
    for (double y = -4.0; y < 4.0; y += 0.45) {
      for (double x = -8.0; x < 8.0; x += random.uniform(0.12, 0.35)) {
        plants_.push_back({{x, y + random.normal(0.02)}, random.uniform(0.6, 1.4)});
      }
    }
  }
  double at(const Eigen::Vector2d& p) const {
    double sum = -0.3;
    for (const Plant& plant : plants_) {
      const double distance2 = (plant.at - p).squaredNorm();
      if (distance2 < 0.09) sum += plant.size * std::exp(-0.5 * distance2 / (0.05 * 0.05));
    }
    return sum;
  }
  /// What a map of so many cells around the origin shows when its point p lies at seen(p).
  template <class Seen>
  SignalMap map(int rows, int cols, const Seen& seen) const {
    SignalMap made;
    made.frame = {{-0.5 * cols * kCell, -0.5 * rows * kCell}, kCell, rows, cols};
    made.weight = Raster<float>(rows, cols, 1.0F);
    for (auto& channel : made.channel) channel = Raster<float>(rows, cols);
    for (int r = 0; r < rows; ++r) {
      for (int c = 0; c < cols; ++c) {
        made.channel[0](r, c) = static_cast<float>(at(seen(made.frame.centre(r, c))));
      }
    }
    made.deviation[0] = 1.0;
    return made;
  }

 private:
  struct Plant {
    Eigen::Vector2d at;
    double size;
  };
  std::vector<Plant> plants_;
};

Eigen::Vector2d straight(const Eigen::Vector2d& p) { return p; }

constexpr int kAlong = 250;  // cells: 10 m
/// Straight, but for one end, which bends 10 cm to the side.
Eigen::Vector2d bent(const Eigen::Vector2d& p) {
  const double u = std::max(0.0, p.x() - 1.0) / 4.0;
  return p + Eigen::Vector2d(0.0, 0.1 * u * u);
}

/// Root mean square of the distance to where the points are, over the strip [m].
double rms(const Eigen::Affine2d& pose, double half_width) {
  double sum = 0.0;
  int count = 0;
  for (double x = -5.0; x <= 5.0; x += 0.1) {
    for (double y = -half_width; y <= half_width; y += 0.1, ++count) {
      sum += (pose * Eigen::Vector2d(x, y) - bent({x, y})).squaredNorm();
    }
  }
  return std::sqrt(sum / count);
}

TEST(BlockRefine, BentStripIsLaidByAllItsParts) {
  const Field field;
  const SignalMap fixed = field.map(150, 380, straight);
  const SignalMap moving = field.map(45, kAlong, bent);
  const DenseRefineResult dense =
      refineDense(fixed, moving, Eigen::Affine2d::Identity(), DenseRefineOptions{});
  ASSERT_EQ(dense.status, RefineStatus::kConverged);
  const auto laid = refineByBlocks(fixed, moving, dense.fixed_from_moving, BlockRefineOptions{});
  ASSERT_TRUE(laid.has_value());
  // The bend moves along y by what depends on x alone: least squares of its line.
  double n = 0.0, xx = 0.0, xd = 0.0, d = 0.0;
  for (double x = -5.0; x <= 5.0; x += 0.1, n += 1.0) {
    const double moved = bent({x, 0.0}).y();
    d += moved;
    xx += x * x;
    xd += x * moved;
  }
  Eigen::Affine2d best = Eigen::Affine2d::Identity();
  best.linear()(1, 0) = xd / xx;
  best.translation().y() = d / n;
  const double lowest = rms(best, 0.9);
  EXPECT_GT(rms(dense.fixed_from_moving, 0.9), 1.1 * lowest) << "else this tests nothing";
  EXPECT_LT(rms(*laid, 0.9), 1.05 * lowest);
  const ThreadLimit one(1);
  const auto alone = refineByBlocks(fixed, moving, dense.fixed_from_moving, BlockRefineOptions{});
  EXPECT_EQ(alone->matrix(), laid->matrix());
}

TEST(BlockRefine, StripOfOneBlocksWidthKeepsItsScaleAcross) {
  const Field field;
  const SignalMap fixed = field.map(150, 380, straight);
  const SignalMap moving = field.map(15, kAlong, straight);
  Eigen::Affine2d start = Eigen::Affine2d::Identity();
  start.linear()(1, 1) = 1.02;
  start.translation() = Eigen::Vector2d(0.03, -0.02);
  const auto laid = refineByBlocks(fixed, moving, start, BlockRefineOptions{});
  ASSERT_TRUE(laid.has_value());
  EXPECT_LT((*laid * Eigen::Vector2d(0.0, 0.0)).norm(), 0.004);
  EXPECT_NEAR(laid->linear()(0, 0), 1.0, 0.001);
  EXPECT_NEAR(laid->linear()(1, 1), 1.02, 0.01);
}

TEST(BlockRefine, NothingWithoutBlocksToCompare) {
  const Field field;
  const SignalMap fixed = field.map(150, 380, straight);
  const SignalMap moving = field.map(20, 30, straight);
  Eigen::Affine2d beside(Eigen::Translation2d(100.0, 0.0));
  EXPECT_FALSE(refineByBlocks(fixed, moving, beside, BlockRefineOptions{}).has_value());
  BlockRefineOptions none;
  none.rounds = 0;
  EXPECT_EQ(refineByBlocks(fixed, moving, beside, none)->matrix(), beside.matrix());
}

}  // namespace
}  // namespace agricolmap
