#include "agricolmap/map/soil_ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace agricolmap::map {
namespace {

TEST(SoilGround, LiesUnderPlantsAndFollowsSlopes) {
  const GridFrame frame{Eigen::Vector2d::Zero(), 0.05, 200, 200};
  Raster<float> surface(200, 200), cover(200, 200);
  for (int r = 0; r < 200; ++r) {
    for (int c = 0; c < 200; ++c) {
      const bool plant = c % 10 < 6;
      cover(r, c) = plant ? 1.0F : 0.0F;
      surface(r, c) = 0.005F * static_cast<float>(c) + (plant ? 0.4F : 0.0F);  // 10 % of slope
    }
  }
  const Raster<float> ground = soilGround(frame, surface, cover);
  for (int c = 20; c < 180; ++c) EXPECT_NEAR(ground(100, c), 0.005 * c, 0.02) << c;
}

TEST(SoilGround, NobodyKnowsItUnderAClosedCanopy) {
  const GridFrame frame{Eigen::Vector2d::Zero(), 0.05, 200, 400};
  Raster<float> surface(200, 400, 0.5F), cover(200, 400, 1.0F);
  for (int r = 0; r < 200; ++r) {
    for (int c = 0; c < 20; ++c) surface(r, c) = cover(r, c) = 0.0F;
  }
  const Raster<float> ground = soilGround(frame, surface, cover);
  EXPECT_NEAR(ground(100, 30), 0.0, 1e-3);
  EXPECT_TRUE(std::isnan(ground(100, 300)));
}

}  // namespace
}  // namespace agricolmap::map
