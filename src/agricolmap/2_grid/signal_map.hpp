// A grid map made comparable across sensors: coarser cells, what varies slower than a plant taken
// out, unit deviation. What the correlation search and the dense refinement look at.
#pragma once

#include "agricolmap/2_grid/grid_map.hpp"
#include "agricolmap/core/options.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap {

/// Which of a map's terms data association and dense refinement use (paper Tab. IV).
enum class DataTerm { kExgHeight, kExg, kHeight, kRgb };
void describeDataTerm(OptionTable& table, DataTerm& term);

struct SignalOptions {
  double high_pass = 0.8;  ///< wavelength above which variation is taken out [m]
  double clip = 4.0;       ///< values beyond this many deviations are cut
  DataTerm term = DataTerm::kExgHeight;
};
void describe(OptionTable& table, SignalOptions& options);

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

/// Mean over a box of (2·radius + 1)² cells, weighted: what `weight` does not cover does not count.
/// Cells with no weight within reach become 0.
Raster<float> weightedBoxMean(const Raster<float>& value, const Raster<float>& weight, int radius);

}  // namespace agricolmap
