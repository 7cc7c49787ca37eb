#include "agricolmap/map/hidden_ground.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/map/box_mean.hpp"

namespace agricolmap::map {

void listOptions(OptionTable& table, HiddenGroundOptions& options) {
  table
      .flag("fill", options.fill,
            "take what a plant hides from the moving map's camera for bare ground when refining")
      .basic();
  table.number("radius", options.radius, 0.02, 10.0, "m",
               "half side of the square that says how many points a cell usually has");
  table.number("whole", options.whole, 0.05, 2.0, "",
               "a cell with this share of the usual number of points was seen whole");
  table.number("bare", options.bare, 0.0, 1.0, "",
               "bare ground lies below this share of the way from soil to plant");
}

namespace {

constexpr float kLeastPoints = 4.0F;  // in a cell, on average: fewer say nothing by their number
constexpr float kLeastBare = 0.05F;   // share of the cells around
// Cells farther from points than these are not behind a plant but beyond the strip.
constexpr int kReach = 2;              // cells
constexpr float kLeastFilled = 0.25F;  // of the cells within reach

Raster<float> luminanceOf(const GridMap& map) {
  Raster<float> bright(map.frame.rows, map.frame.cols);
  for (std::size_t i = 0; i < bright.size(); ++i) bright[i] = luminance(map.colour[i]);
  return bright;
}

/// Grey: of a signal's colours only the luminance is read.
Rgb greyOf(float bright) {
  const auto level =
      static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(bright, 0.0F, 1.0F)));
  return {level, level, level};
}

}  // namespace

Raster<float> bareGround(const GridMap& map, double share) {
  std::vector<float> exg, height;
  for (std::size_t i = 0; i < map.weight.size(); ++i) {
    if (!map.valid(i)) continue;
    exg.push_back(map.exg[i]);
    height.push_back(map.height[i]);
  }
  const auto limit = [&](std::vector<float>& values) {
    const float low = quantile(values, 0.1), high = quantile(values, 0.9);
    return std::pair{low + static_cast<float>(share) * (high - low), high > low};
  };
  Raster<float> bare(map.frame.rows, map.frame.cols);
  if (exg.empty()) return bare;
  const auto [greenest, coloured] = limit(exg);
  const auto [highest, relief] = limit(height);
  for (std::size_t i = 0; i < bare.size(); ++i) {
    if (!map.valid(i)) continue;
    const bool is_bare = coloured ? map.exg[i] < greenest : relief && map.height[i] < highest;
    bare[i] = is_bare ? 1.0F : 0.0F;
  }
  return bare;
}

GridMap withHiddenGround(const GridMap& map, const HiddenGroundOptions& options) {
  GridMap filled = map;
  if (!options.fill) return filled;
  const int radius = std::max(1, static_cast<int>(std::lround(options.radius / map.frame.cell)));
  Raster<float> seen(map.frame.rows, map.frame.cols);
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = map.valid(i) ? 1.0F : 0.0F;
  const Raster<float> all(map.frame.rows, map.frame.cols, 1.0F);
  const Raster<float> bare = bareGround(map, options.bare);
  const Raster<float> bare_share = BoxMean(all, radius).of(bare);
  const BoxMean of_bare(bare, radius);
  const Raster<float> soil = of_bare.of(map.exg);
  const Raster<float> ground = of_bare.of(map.height);
  const Raster<float> bright = luminanceOf(map);
  const Raster<float> soil_bright = of_bare.of(bright);
  const Raster<float> usual = BoxMean(seen, radius).of(map.weight);
  const Raster<float> around = BoxMean(all, kReach).of(seen);
  const auto whole = static_cast<float>(options.whole);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (usual[i] < kLeastPoints || bare_share[i] < kLeastBare || around[i] < kLeastFilled) continue;
    const float share = map.weight[i] / (whole * usual[i]);
    if (share >= 1.0F) continue;
    filled.exg[i] = share * map.exg[i] + (1.0F - share) * soil[i];
    filled.height[i] = share * map.height[i] + (1.0F - share) * ground[i];
    filled.colour[i] = greyOf(share * bright[i] + (1.0F - share) * soil_bright[i]);
    if (!map.valid(i)) {
      filled.weight[i] = 1.0F;
      ++filled.filled;
    }
  }
  return filled;
}

}  // namespace agricolmap::map
