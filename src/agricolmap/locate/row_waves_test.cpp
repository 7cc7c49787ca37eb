#include "agricolmap/locate/row_waves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "agricolmap/map/test_field.hpp"

namespace agricolmap::locate {
namespace {

using testing::growField;
using testing::guessError;
using testing::TestField;
using testing::Truth;
using testing::viewOf;

constexpr double kMinStrength = 12.0;

struct Views {
  map::GridMap fixed;
  map::GridMap moving;
  Hypothesis truth;
};

Views rowField(double yaw, double scale_x, double scale_y) {
  TestField field;
  field.seed = 31;
  const Truth truth = growField(field);
  const Eigen::Vector2d middle = Eigen::Vector2d::Constant(0.5 * field.size);
  Views views;
  views.truth = {yaw, {scale_x, scale_y}};
  views.fixed = viewOf(truth, field,
                       map::Box2(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(field.size)),
                       Eigen::Affine2d::Identity(), 0.02, 1);
  views.moving =
      viewOf(truth, field,
             map::Box2(middle - Eigen::Vector2d(4.0, 1.1), middle + Eigen::Vector2d(4.0, 1.1)),
             guessError(middle, {0.5, -0.4}, yaw, scale_x, scale_y), 0.05, 2);
  return views;
}

TEST(RowWaves, TheRowsAreTheStrongestWave) {
  const auto waves = strongestWaves(rowField(0.0, 1.0, 1.0).fixed, {}, 3, kMinStrength);
  ASSERT_FALSE(waves.empty());
  // Rows 0.45 m apart along x; a harmonic may be stronger.
  const double spacing = 1.0 / waves.front().vector.norm();
  const double harmonic = 0.45 / spacing;
  EXPECT_NEAR(harmonic, std::round(harmonic), 0.03);
  EXPECT_LT(std::abs(waves.front().vector.x()), 0.02 * std::abs(waves.front().vector.y()));
}

TEST(RowWaves, TheTrueHeadingAndScalesLayRowsOnRows) {
  for (const auto& [yaw, scale_x, scale_y] :
       {std::tuple{0.2, 1.2, 0.8}, {-2.4, 0.85, 1.25}, {1.4, 1.0, 0.9}}) {
    const Views views = rowField(yaw, scale_x, scale_y);
    const auto fixed = strongestWaves(views.fixed, {}, 2, kMinStrength);
    const auto moving = strongestWaves(views.moving, {}, 2, kMinStrength);
    const WaveTolerance tolerance{.along = 0.12, .across = 0.08};
    const SearchSpace space;
    EXPECT_EQ(alongWaves({views.truth}, moving, fixed, space, tolerance).size(), 1U) << yaw;
    // The strip turned end for end has the same rows; a quarter turn has not.
    Hypothesis turned = views.truth;
    turned.yaw += std::numbers::pi;
    EXPECT_EQ(alongWaves({turned}, moving, fixed, space, tolerance).size(), 1U) << yaw;
    turned.yaw += 0.5 * std::numbers::pi;
    EXPECT_TRUE(alongWaves({turned}, moving, fixed, space, tolerance).empty()) << yaw;
  }
}

TEST(RowWaves, NoiseHasNoWaves) {
  map::GridMap map = rowField(0.0, 1.0, 1.0).moving;
  Random random(7);
  for (float& value : map.exg) value = static_cast<float>(random.normal());
  EXPECT_TRUE(strongestWaves(map, {}, 2, kMinStrength).empty());
}

TEST(RowWaves, AMapOfAFewCellsHasNoWaves) {
  map::GridMap map;
  map.frame = {Eigen::Vector2d::Zero(), 0.02, 3, 2};
  map.weight = Raster<float>(3, 2, 1.0F);
  map.height = map.exg = map.weight;
  map.colour = Raster<Rgb>(3, 2);
  EXPECT_TRUE(strongestWaves(map, {}, 2, kMinStrength).empty());
}

}  // namespace
}  // namespace agricolmap::locate
