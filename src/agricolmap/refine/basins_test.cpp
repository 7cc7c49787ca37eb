#include "agricolmap/refine/basins.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/map/test_field.hpp"

namespace agricolmap::refine {
namespace {

constexpr double kCell = 0.04;

/// Plants every 8 cm in rows, of sizes that repeat nowhere: next to each place is another that fits
/// almost as well.
class Drilled {
 public:
  Drilled() {
    Random random(7);
    for (double& size : sizes_) size = random.uniform(0.6, 1.4);
  }
  float at(const Eigen::Vector2d& p) const {
    const double col = std::floor(p.x() / 0.08), row = std::floor(p.y() / 0.16);
    const Eigen::Vector2d off(p.x() - (col + 0.5) * 0.08, p.y() - (row + 0.5) * 0.16);
    const int plant = (static_cast<int>(col) + 100 + 211 * (static_cast<int>(row) + 100)) % 4001;
    return static_cast<float>(sizes_[static_cast<std::size_t>(plant)] *
                                  std::exp(-0.5 * off.squaredNorm() / (0.025 * 0.025)) -
                              0.25);
  }
  map::SignalMap map(int rows, int cols, const Eigen::Vector2d& corner) const {
    return testing::signalOf({corner, kCell, rows, cols}, [&](const auto& p) { return at(p); });
  }

 private:
  std::array<double, 4001> sizes_{};
};

TEST(Basins, NextPlantIsLeftForTheRightOne) {
  const Drilled field;
  const map::SignalMap fixed = field.map(80, 150, {-1.0, -1.0});
  const map::SignalMap moving = field.map(30, 100, {0.0, 0.0});
  const Eigen::Affine2d start(Eigen::Translation2d(0.08, 0.0));
  DenseRefineOptions options;
  options.hop = 2.0;
  const DenseRefineResult caught = refineDense(fixed, moving, start, options);
  EXPECT_GT(caught.fixed_from_moving.translation().norm(), 0.03) << "else this tests nothing";
  const DenseRefineResult right = refineAcrossBasins(fixed, moving, start, options);
  ASSERT_EQ(right.status, RefineStatus::kConverged);
  EXPECT_LT(right.fixed_from_moving.translation().norm(), 0.002);
  EXPECT_GT(right.correlation, caught.correlation + 0.01);
  const ThreadLimit one(1);
  EXPECT_EQ(refineAcrossBasins(fixed, moving, start, options).fixed_from_moving.matrix(),
            right.fixed_from_moving.matrix());
}

TEST(Basins, WithoutOverlapItSaysSo) {
  const Drilled field;
  const map::SignalMap fixed = field.map(30, 30, {0.0, 0.0});
  const map::SignalMap moving = field.map(30, 30, {0.0, 0.0});
  const Eigen::Affine2d far(Eigen::Translation2d(50.0, 0.0));
  EXPECT_EQ(refineAcrossBasins(fixed, moving, far, {}).status, RefineStatus::kNoOverlap);
}

}  // namespace
}  // namespace agricolmap::refine
