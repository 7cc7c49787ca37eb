#include "agricolmap/map/hidden_ground.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/random.hpp"

namespace agricolmap::map {
namespace {

constexpr float kSoil = -0.02F;
constexpr float kPlant = 0.3F;

/// 40 × 40 cells of 2 cm, 20 points each: bare ground with a plant 10 cm high in columns 20 to 24,
/// behind which, in columns 25 and 26, only leaves were seen, by 6 points a cell, and in 27
/// nothing.
GridMap mapWithShadow() {
  GridMap map;
  map.frame.cell = 0.02;
  map.frame.rows = map.frame.cols = 40;
  map.weight = Raster<float>(40, 40, 20.0F);
  map.exg = Raster<float>(40, 40, kSoil);
  map.height = Raster<float>(40, 40, 0.01F);
  map.colour = Raster<Rgb>(40, 40);
  for (int r = 0; r < 40; ++r) {
    for (int c = 20; c < 27; ++c) {
      map.exg(r, c) = kPlant;
      map.height(r, c) = 0.1F;
      if (c >= 25) map.weight(r, c) = 6.0F;
    }
    map.weight(r, 27) = map.exg(r, 27) = map.height(r, 27) = 0.0F;
  }
  map.filled = 40 * 39;
  return map;
}

TEST(HiddenGround, IsSoilForTheShareThatWasNotSeen) {
  const GridMap map = mapWithShadow();
  const GridMap filled = withHiddenGround(map, {});
  EXPECT_FLOAT_EQ(filled.exg(20, 22), kPlant);
  EXPECT_FLOAT_EQ(filled.exg(20, 10), kSoil);
  // A little more than half seen: 6 points of 60 % of the 18 or so that are usual around.
  EXPECT_GT(filled.exg(20, 25), 0.35F * kPlant);
  EXPECT_LT(filled.exg(20, 25), 0.75F * kPlant);
  EXPECT_LT(filled.height(20, 25), 0.08F);
  EXPECT_TRUE(filled.valid(20, 27));
  EXPECT_NEAR(filled.exg(20, 27), kSoil, 1e-6);
  EXPECT_NEAR(filled.height(20, 27), 0.01, 1e-6);
  EXPECT_EQ(filled.filled, map.filled + 40);
}

// What counts are the points, not the weights that their means are made with.
TEST(HiddenGround, IsFoundWhateverTheWidthOfTheGaussian) {
  Random random(5);
  Cloud cloud;
  cloud.name = "strip";
  for (int i = 0; i < 40 * 40 * 12; ++i) {
    const double x = random.uniform(0, 0.8), y = random.uniform(0, 0.8);
    if (x > 0.54 && x < 0.56) continue;
    cloud.xyz.push_back(Eigen::Vector3d(x, y, x > 0.4 && x < 0.54 ? 0.1 : 0.0).cast<float>());
  }
  for (const double sigma : {0.04, 0.004, 0.0004}) {
    const GridMap map =
        makeGridMap(cloud, Eigen::Affine3d::Identity(),
                    {Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(0.8)}, {.sigma = sigma});
    ASSERT_FALSE(map.valid(20, 27));
    const GridMap filled = withHiddenGround(map, {});
    EXPECT_TRUE(filled.valid(20, 27)) << "sigma " << sigma;
    EXPECT_NEAR(filled.height(20, 27), 0.0, 1e-3) << "sigma " << sigma;
  }
}

TEST(HiddenGround, IsFoundByHeightWithoutColours) {
  GridMap map = mapWithShadow();
  for (float& exg : map.exg) exg = 0.0F;
  const GridMap filled = withHiddenGround(map, {});
  EXPECT_NEAR(filled.height(20, 27), 0.01, 1e-6);
  EXPECT_EQ(filled.exg(20, 25), 0.0F);
}

TEST(HiddenGround, StaysUnknownBeyondTheStripInSparseMapsAndWhenSwitchedOff) {
  GridMap map = mapWithShadow();
  for (int r = 0; r < 40; ++r) {
    for (int c = 33; c < 40; ++c) map.weight(r, c) = 0.0F;
  }
  const GridMap filled = withHiddenGround(map, {});
  EXPECT_FALSE(filled.valid(20, 36)) << "no plant reaches so far";
  EXPECT_TRUE(filled.valid(20, 27));
  EXPECT_FALSE(withHiddenGround(map, {.fill = false}).valid(20, 27));
  for (float& weight : map.weight) weight *= 0.1F;
  const GridMap sparse = withHiddenGround(map, {});
  EXPECT_FALSE(sparse.valid(20, 27));
  EXPECT_FLOAT_EQ(sparse.exg(20, 25), kPlant);
}

TEST(HiddenGround, NothingIsInventedWithoutBareGround) {
  GridMap map = mapWithShadow();
  for (std::size_t i = 0; i < map.exg.size(); ++i) map.exg[i] = map.height[i] = 0.2F;
  EXPECT_FALSE(withHiddenGround(map, {}).valid(20, 27));
  const GridMap empty = withHiddenGround(GridMap{}, {});
  EXPECT_EQ(empty.filled, 0U);
}

}  // namespace
}  // namespace agricolmap::map
