#include "agricolmap/map/soil_texture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/random.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::map {
namespace {

constexpr int kSide = 120;  // cells of 2 cm

std::uint8_t level(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// Bare soil with leaves over it in bands, drawn by `leaves`; `shadow` is what is left of the light
/// in soft stripes of 0.6 m across the bands.
GridMap field(unsigned leaves, double shadow) {
  GridMap map;
  map.frame.cell = 0.02;
  map.frame.rows = map.frame.cols = kSide;
  map.weight = Raster<float>(kSide, kSide, 1.0F);
  map.height = Raster<float>(kSide, kSide);
  map.exg = Raster<float>(kSide, kSide);
  map.colour = Raster<Rgb>(kSide, kSide);
  Random soil(7), leaf(leaves);
  for (int r = 0; r < kSide; ++r) {
    for (int c = 0; c < kSide; ++c) {
      const double bright = 120.0 + 12.0 * soil.normal();
      const double light = 0.5 * (1.0 + shadow + (1.0 - shadow) * std::sin(0.1 * c));
      map.colour(r, c) = {level(bright * light), level(bright * light), level(bright * light)};
      map.exg(r, c) = static_cast<float>(0.02 + 0.005 * leaf.normal());
      if ((r / 10) % 3 != 0) continue;
      if (leaf.uniform() < 0.5) continue;
      const double green = light * (90.0 + 60.0 * leaf.uniform());
      map.colour(r, c) = {level(0.5 * green), level(green), level(0.4 * green)};
      map.exg(r, c) = static_cast<float>(0.4 + 0.02 * leaf.normal());
    }
  }
  return map;
}

/// Correlation of two rasters where both are not 0.
double correlation(const Raster<float>& a, const Raster<float>& b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const auto x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
    if (a[i] == 0.0F || b[i] == 0.0F) continue;
    ab += x * y;
    aa += x * x;
    bb += y * y;
  }
  return ab / std::sqrt(aa * bb);
}

/// Of a map whose greenness tells plants from soil, as all of `field` does.
constexpr float kSoilBelow = 0.2F;

TEST(SoilTexture, IsTheSameUnderOtherLeavesAndShadows) {
  EXPECT_GT(
      correlation(soilTexture(field(1, 1.0), kSoilBelow), soilTexture(field(2, 0.4), kSoilBelow)),
      0.8);
}

TEST(SoilTexture, CarriesTwoViewsWhoseLeavesAndShadowsHaveNothingInCommon) {
  GridMap one = field(1, 1.0), other = field(2, 0.4);
  const auto agreement = [&] {
    const SignalOptions bright{.term = SignalTerm::kRgb};
    return correlation(makeSignalMap(one, 1, bright).channel[kLuminanceChannel],
                       makeSignalMap(other, 1, bright).channel[kLuminanceChannel]);
  };
  // With the luminance as it is leaves and the borders of shadows drown what is shared.
  EXPECT_LT(agreement(), 0.4);
  tellSoil(one, other);
  EXPECT_GT(agreement(), 0.6);
}

TEST(SoilTexture, DoesNotEnlargeNoiseWhereNothingIsSeen) {
  GridMap map = field(1, 1.0);
  for (int r = 62; r < 88; ++r) {
    for (int c = 40; c < 70; ++c) {
      const auto bright = static_cast<std::uint8_t>(120 + (r + c) % 2);
      map.colour(r, c) = {bright, bright, bright};
      map.exg(r, c) = 0.02F;
    }
  }
  const Raster<float> texture = soilTexture(map, kSoilBelow);
  for (int r = 70; r < 80; ++r) {
    for (int c = 48; c < 62; ++c) EXPECT_LT(std::abs(texture(r, c)), 0.5F);
  }
}

TEST(SoilTexture, IsComparedOnlyWhereBothMapsTellPlantsFromSoil) {
  GridMap one = field(1, 1.0), other = field(2, 0.4);
  tellSoil(one, other);
  ASSERT_TRUE(one.soil_below && other.soil_below);
  EXPECT_GT(*one.soil_below, 0.02F) << "of the soil";
  EXPECT_LT(*one.soil_below, 0.4F) << "of the leaves";
  EXPECT_EQ(croppedMap(one, {Eigen::Vector2d(0.2, 0.2), Eigen::Vector2d(0.6, 0.6)}).soil_below,
            one.soil_below);
  GridMap grey = field(1, 1.0);
  std::fill(grey.exg.begin(), grey.exg.end(), 0.0F);
  tellSoil(one, grey);
  EXPECT_FALSE(one.soil_below || grey.soil_below);
  EXPECT_TRUE(makeSignalMap(grey, 1, {}).has(kLuminanceChannel));
}

}  // namespace
}  // namespace agricolmap::map
