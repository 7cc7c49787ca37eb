// A grid map made comparable across sensors: coarser cells, what varies slower than a plant taken
// out, unit deviation. What the correlation search and the dense refinement look at.
#pragma once

#include <cmath>

#include "agricolmap/core/bilinear.hpp"
#include "agricolmap/core/options.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

/// What of two maps is compared.
enum class SignalTerm {
  kAll,        ///< Excess Green, height and luminance
  kExgHeight,  ///< what the paper compares
  kRgb,        ///< luminance alone
  kExg,        ///< Excess Green alone
  kHeight,     ///< height alone
};

struct SignalOptions {
  double high_pass = 1.2;  ///< wavelength above which variation is taken out [m]
  double clip = 4.0;       ///< values beyond this many deviations are cut
  SignalTerm term = SignalTerm::kAll;
};
void listOptions(OptionTable& table, SignalOptions& options);

/// The channels of a SignalMap. Plants tell places apart by the first two, and they grow; soil,
/// stones, straw and tillage by the third, which is the soil's texture (`soil_texture.hpp`) where
/// plants can be told from it, free of leaves and shadows, and else the luminance as it is.
inline constexpr int kGreenChannel = 0;
inline constexpr int kHeightChannel = 1;
inline constexpr int kLuminanceChannel = 2;
inline constexpr int kSignalChannels = 3;

/// Per cell a high-passed value per channel with mean 0 and deviation 1 over the valid cells, and
/// the share of the cell that was seen. Where `weight` is 0 all values are 0.
struct SignalMap {
  GridFrame frame;
  Raster<float> weight;  ///< share of filled fine cells, 0…1
  Raster<float> channel[kSignalChannels];
  /// What was divided by: ExG units, metres, share of white or, of soil texture, its own
  /// deviations. 0: the channel is left out, or flat.
  double deviation[kSignalChannels] = {};
  bool has(int k) const { return deviation[k] > 0.0; }
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
  SignalSample sample;
  const auto cells = cellsWithin<float>(map.frame.rows, map.frame.cols, cell.x(), cell.y());
  if (!cells) return sample;
  const std::size_t i = map.weight.index(cells->row, cells->col);
  const std::size_t j = i + static_cast<std::size_t>(map.frame.cols);
  const auto [a, b, c, d] = cells->shares();
  const float corner[4] = {a * map.weight[i], b * map.weight[i + 1], c * map.weight[j],
                           d * map.weight[j + 1]};
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

}  // namespace agricolmap::map
