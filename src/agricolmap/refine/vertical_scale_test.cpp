#include "agricolmap/refine/vertical_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/random.hpp"

namespace agricolmap::refine {
namespace {

constexpr double kPatch = 0.6;

struct Scene {
  std::vector<GroundCell> cells;
  std::vector<double> ground;
  std::vector<double> lift;
};

/// Bare ground of 10 m × 2 m that rises and falls by `relief`, `scale` times as much in the fixed
/// map, whose moving map drifts by `drift`.
Scene sceneOf(double relief, double scale, double drift) {
  Scene scene;
  Random random(7);
  for (double x = -5.0; x < 5.0; x += 0.04) {
    for (double y = -1.0; y < 1.0; y += 0.04) {
      const double rise = relief * std::sin(1.1 * x + 0.3 * y);
      const double moving = 0.03 * x + rise + drift * std::sin(1.9 * x) + random.normal(0.004);
      const double fixed = 0.4 - 0.01 * y + scale * rise + random.normal(0.004);
      GroundCell cell{};
      cell.place = {x, y};
      cell.moving_height = moving;
      cell.difference = fixed - moving;
      scene.cells.push_back(cell);
    }
  }
  scene.ground.assign(scene.cells.size(), 1.0);
  scene.lift.assign(scene.cells.size(), 0.0);
  return scene;
}

VerticalScale scaleOf(const Scene& scene) {
  return measureVerticalScale(scene.cells, scene.ground, scene.lift, kPatch);
}

TEST(VerticalScale, IsWhatTheReliefOfTheGroundTells) {
  for (const double true_scale : {0.8, 1.0, 1.25}) {
    const VerticalScale scale = scaleOf(sceneOf(0.2, true_scale, 0.0));
    EXPECT_TRUE(scale.measured());
    EXPECT_NEAR(scale.value, true_scale, 2.0 * scale.deviation);
    EXPECT_NEAR(scale.value, true_scale, 0.01);
    EXPECT_EQ(scale.clear(), true_scale != 1.0);
  }
}

TEST(VerticalScale, IsNotToldByFlatGround) {
  EXPECT_FALSE(scaleOf(sceneOf(0.0, 1.2, 0.0)).measured());
}

// What one map drifts by has no like in the other: the two regressions part.
TEST(VerticalScale, DriftWidensItsInterval) {
  const VerticalScale straight = scaleOf(sceneOf(0.1, 1.1, 0.0));
  const VerticalScale drifting = scaleOf(sceneOf(0.1, 1.1, 0.04));
  EXPECT_GT(drifting.deviation, 2.0 * straight.deviation);
  EXPECT_NEAR(drifting.value, 1.1, 2.0 * drifting.deviation);
  EXPECT_FALSE(scaleOf(sceneOf(0.02, 1.1, 0.04)).measured());
}

TEST(VerticalScale, NeedsGroundInManyPlaces) {
  Scene scene = sceneOf(0.2, 1.2, 0.0);
  for (std::size_t i = 0; i < scene.cells.size(); ++i) {
    if (scene.cells[i].place.x() > -3.0) scene.ground[i] = 0.1;
  }
  EXPECT_FALSE(scaleOf(scene).measured());
}

TEST(VerticalScale, TakesOffWhatBlurLifts) {
  Scene scene = sceneOf(0.2, 1.2, 0.0);
  for (std::size_t i = 0; i < scene.cells.size(); ++i) {
    const double x = scene.cells[i].place.x();
    scene.lift[i] = 0.1 * std::sin(1.1 * x);
    scene.cells[i].difference += scene.lift[i];
  }
  EXPECT_NEAR(scaleOf(scene).value, 1.2, 0.01);
}

}  // namespace
}  // namespace agricolmap::refine
