// A grid map made comparable across sensors: coarser cells, what varies slower than a plant taken
// out, unit deviation. What the correlation search and the dense refinement look at.
#pragma once

#include <cmath>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/data_term.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

struct SignalOptions {
  double high_pass = 0.8;  ///< wavelength above which variation is taken out [m]
  double clip = 4.0;       ///< values beyond this many deviations are cut
  DataTerm term = DataTerm::kExgHeight;
};
void listOptions(OptionTable& table, SignalOptions& options);

/// Number of channels of a SignalMap: greenness (or luminance) and height.
inline constexpr int kSignalChannels = 2;

/// Per cell a high-passed value per channel with mean 0 and deviation 1 over the valid cells, and
/// the share of the cell that was seen. Where `weight` is 0 all values are 0.
struct SignalMap {
  GridFrame frame;
  Raster<float> weight;                    ///< share of filled fine cells, 0…1
  Raster<float> channel[kSignalChannels];  ///< greenness, height
  double deviation[kSignalChannels] = {};  ///< what was divided by: ExG units, metres
};

/// Averages `factor × factor` cells of `map` and high-passes them. A channel that `options.term`
/// leaves out stays 0.
SignalMap makeSignalMap(const GridMap& map, int factor, const SignalOptions& options);

/// A signal map's values at a point; weight 0 outside the map and beside empty cells.
struct SignalSample {
  float weight = 0.0F;
  float value[kSignalChannels] = {};
};

/// Bilinear between the cell centres around `point` (levelled frame [m]).
inline SignalSample sampleSignal(const SignalMap& map, const Eigen::Vector2d& point) {
  const Eigen::Vector2d cell = map.frame.cellOf(point);
  const double floor_c = std::floor(cell.x());
  const double floor_r = std::floor(cell.y());
  SignalSample sample;
  if (!(floor_c >= 0.0 && floor_r >= 0.0 && floor_c + 1.0 < map.frame.cols &&
        floor_r + 1.0 < map.frame.rows)) {
    return sample;
  }
  const auto u = static_cast<float>(cell.x() - floor_c);
  const auto v = static_cast<float>(cell.y() - floor_r);
  const std::size_t i = map.weight.index(static_cast<int>(floor_r), static_cast<int>(floor_c));
  const std::size_t j = i + static_cast<std::size_t>(map.frame.cols);
  const float corner[4] = {(1 - u) * (1 - v) * map.weight[i], u * (1 - v) * map.weight[i + 1],
                           (1 - u) * v * map.weight[j], u * v * map.weight[j + 1]};
  sample.weight = corner[0] + corner[1] + corner[2] + corner[3];
  if (sample.weight <= 0.0F) return sample;
  for (int k = 0; k < kSignalChannels; ++k) {
    const Raster<float>& value = map.channel[k];
    sample.value[k] = (corner[0] * value[i] + corner[1] * value[i + 1] + corner[2] * value[j] +
                       corner[3] * value[j + 1]) /
                      sample.weight;
  }
  return sample;
}

/// Mean over a box of (2·radius + 1)² cells, weighted: what `weight` does not cover does not count.
/// Cells with no weight within reach become 0.
Raster<float> weightedBoxMean(const Raster<float>& value, const Raster<float>& weight, int radius);

}  // namespace agricolmap::map
