// The ground under the plants, from the soil that is seen between them.
#pragma once

#include "agricolmap/core/raster.hpp"

namespace agricolmap::map {

/// Farther than this from all soil that is seen nobody knows the ground [m].
inline constexpr double kSoilReach = 2.0;

/// Ground height of every cell, NaN where no soil is seen within kSoilReach. `surface`: heights,
/// NaN where there is none; `cover`: share of vegetation 0…1, NaN where nobody knows: such cells
/// count as soil only where they are the lowest around. Low quantiles of the soil in squares of a
/// quarter metre, those far above their neighbours left out, with smooth filling between.
Raster<float> soilGround(const GridFrame& frame, const Raster<float>& surface,
                         const Raster<float>& cover);

}  // namespace agricolmap::map
