#include "agricolmap/map/soil_texture.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/map/box_mean.hpp"
#include "agricolmap/map/vegetation.hpp"

namespace agricolmap::map {
namespace {

/// The mean and the deviation are those of boxes of 2 · 3 + 1 cells, twice: wide enough to hold
/// some texture, narrower than plants and their shadows.
constexpr int kRadius = 3;
/// Where the soil varies less than this share of what it usually does (a hole that was filled, deep
/// shadow) there is nothing but noise to enlarge.
constexpr float kLeastShare = 0.25F;

}  // namespace

void tellSoil(GridMap& fixed, GridMap& moving) {
  const VegetationThreshold there = vegetationThreshold(fixed, {});
  const VegetationThreshold here = vegetationThreshold(moving, {});
  const bool told = there.status == VegetationStatus::kOk && here.status == VegetationStatus::kOk;
  const auto below = [&](const VegetationThreshold& plants) {
    return told ? std::optional(static_cast<float>(plants.threshold)) : std::nullopt;
  };
  fixed.soil_below = below(there);
  moving.soil_below = below(here);
}

Raster<float> soilTexture(const GridMap& map, float soil_below) {
  Raster<float> soil(map.frame.rows, map.frame.cols);
  Raster<float> texture(map.frame.rows, map.frame.cols);
  for (std::size_t i = 0; i < soil.size(); ++i) {
    if (!map.valid(i) || map.exg[i] >= soil_below) continue;
    soil[i] = 1.0F;
    texture[i] = luminance(map.colour[i]);
  }
  const BoxMean around(soil, kRadius);
  const Raster<float> mean = around.of(around.of(texture));
  Raster<float> square(map.frame.rows, map.frame.cols);
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < soil.size(); ++i) {
    texture[i] = soil[i] * (texture[i] - mean[i]);
    square[i] = texture[i] * texture[i];
    sum += static_cast<double>(square[i]);
    count += static_cast<double>(soil[i]);
  }
  const auto usual = static_cast<float>(std::sqrt(sum / std::max(1.0, count)));
  if (usual <= 0.0F) return texture;
  const Raster<float> variance = around.of(around.of(square));
  for (std::size_t i = 0; i < soil.size(); ++i) {
    texture[i] /= std::max(kLeastShare * usual, std::sqrt(variance[i]));
  }
  return texture;
}

}  // namespace agricolmap::map
