// What is seen of the soil whatever shadow lies on it: clods, stones, straw and tillage, which two
// views share when plants have grown, leaves have moved and the sun has gone round.
#pragma once

#include <optional>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

/// Per cell the luminance of the soil over its mean within some cells, in its deviations there; 0
/// where plants are or nothing was seen. A shadow multiplies both, and its borders are wider than
/// that. Nothing where Excess Green does not tell plants from soil (`vegetationThreshold`).
std::optional<Raster<float>> soilTexture(const GridMap& map);

}  // namespace agricolmap::map
