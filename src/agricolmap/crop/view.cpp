#include "agricolmap/crop/view.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::crop {

Greenness greennessOf(const View& view, const map::VegetationOptions& options) {
  map::GridMap map;
  map.frame = view.frame;
  map.exg = view.exg;
  map.weight = Raster<float>(view.frame.rows, view.frame.cols);
  for (std::size_t i = 0; i < map.exg.size(); ++i) {
    map.weight[i] = std::isfinite(map.exg[i]) ? 1.0F : 0.0F;
    if (map.weight[i] == 0.0F) map.exg[i] = 0.0F;
  }
  Greenness result;
  result.threshold = map::vegetationThreshold(map, options);
  if (!result.known()) return result;
  const auto soil = static_cast<float>(result.threshold.soil_mean);
  const auto scale =
      1.0F / static_cast<float>(result.threshold.vegetation_mean - result.threshold.soil_mean);
  result.leaf = scale * (static_cast<float>(result.threshold.threshold) - soil);
  result.green = std::move(map.exg);
  for (std::size_t i = 0; i < result.green.size(); ++i) {
    result.green[i] =
        map.weight[i] > 0.0F ? std::clamp(scale * (result.green[i] - soil), -0.5F, 1.5F) : kUnknown;
  }
  return result;
}

CoarseGreen coarseGreen(const GridFrame& frame, const Raster<float>& green, int step) {
  CoarseGreen coarse;
  coarse.frame = frame;
  coarse.frame.cell = step * frame.cell;
  coarse.frame.rows = (frame.rows + step - 1) / step;
  coarse.frame.cols = (frame.cols + step - 1) / step;
  coarse.green = Raster<float>(coarse.frame.rows, coarse.frame.cols, kUnknown);
  parallelFor(
      static_cast<std::size_t>(coarse.frame.rows),
      [&](std::size_t item) {
        const int r = static_cast<int>(item);
        for (int c = 0; c < coarse.frame.cols; ++c) {
          float sum = 0.0F;
          int count = 0;
          for (int y = r * step; y < std::min(frame.rows, (r + 1) * step); ++y) {
            for (int x = c * step; x < std::min(frame.cols, (c + 1) * step); ++x) {
              if (!std::isfinite(green(y, x))) continue;
              sum += green(y, x);
              ++count;
            }
          }
          if (4 * count >= step * step) coarse.green(r, c) = sum / static_cast<float>(count);
        }
      },
      16);
  return coarse;
}

}  // namespace agricolmap::crop
