#include "agricolmap/verdict/sides.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace agricolmap::verdict {
namespace {

/// Blocks of 1 m of a strip of 20 × 4 m along x, displaced as `offset(along, across)` says.
Evidence evidenceWith(const std::function<Eigen::Vector2d(double, double)>& offset) {
  Evidence evidence;
  evidence.strip.half_extent = {10.0, 2.0};
  evidence.block_size = {1.0, 1.0};
  for (double x = -9.5; x < 10.0; x += 1.0) {
    for (double y = -1.5; y < 2.0; y += 1.0) {
      evidence.blocks.push_back({{x, y}, {x, y}, offset(x, y), true});
    }
  }
  return evidence;
}

TEST(SidesApart, TellsTwoPassesFromOneThatBends) {
  const auto two = sidesApart(evidenceWith(
      [](double x, double y) { return Eigen::Vector2d(y > 0.0 ? 0.005 * x : -0.005 * x, 0.02); }));
  ASSERT_TRUE(two);
  EXPECT_NEAR(*two, 0.05, 0.01);
  EXPECT_FALSE(sidesApart(
      evidenceWith([](double x, double) { return Eigen::Vector2d(0.001 * x * x, 0.005 * x); })));
}

TEST(SidesApart, NoiseOfBlocksIsNone) {
  EXPECT_FALSE(sidesApart(evidenceWith([](double x, double y) -> Eigen::Vector2d {
    return 0.04 * Eigen::Vector2d(std::sin(17.0 * x + 5.0 * y), std::cos(23.0 * x - 11.0 * y));
  })));
}

}  // namespace
}  // namespace agricolmap::verdict
