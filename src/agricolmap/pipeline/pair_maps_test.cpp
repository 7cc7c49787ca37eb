#include "agricolmap/pipeline/pair_maps.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "agricolmap/core/transform.hpp"

namespace agricolmap::pipeline {
namespace {

// Every place where a strip may come to lie is in the window, whatever is known of the heading.
TEST(ReachableWindow, HoldsTheStripAtAllHeadingsOfThePrior) {
  const map::Box2 strip(Eigen::Vector2d(2.0, 1.0), Eigen::Vector2d(12.0, 3.2));
  for (const double heading_deg : {0.0, 11.5, 60.0, 135.0, 180.0}) {
    SearchSpace space;
    space.centre = strip.center();
    space.uncertainty.translation = 0.5;
    space.uncertainty.heading_deg = heading_deg;
    const double rim = 1.0;
    const map::Box2 window = reachableWindow(strip, space, rim);
    const double stretch = std::exp(logScaleLimit(space.uncertainty));
    map::Box2 reached;
    for (int i = -1000; i <= 1000; ++i) {
      const double yaw = i / 1000.0 * heading_deg * std::numbers::pi / 180.0;
      for (int corner = 0; corner < 4; ++corner) {
        const Eigen::Vector2d arm =
            strip.corner(static_cast<map::Box2::CornerType>(corner)) - space.centre;
        reached.extend((space.centre + stretch * (rotation2(yaw) * arm)).eval());
      }
    }
    const Eigen::Vector2d margin = Eigen::Vector2d::Constant(0.5 + rim);
    EXPECT_LT((window.min() - (reached.min() - margin)).cwiseAbs().maxCoeff(), 1e-4)
        << heading_deg << " deg: " << window.sizes().transpose();
    EXPECT_LT((window.max() - (reached.max() + margin)).cwiseAbs().maxCoeff(), 1e-4)
        << heading_deg << " deg: " << window.sizes().transpose();
  }
}

}  // namespace
}  // namespace agricolmap::pipeline
