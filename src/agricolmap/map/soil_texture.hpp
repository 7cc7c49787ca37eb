// What is seen of the soil whatever shadow lies on it: clods, stones, straw and tillage, which two
// views share when plants have grown, leaves have moved and the sun has gone round.
#pragma once

#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

/// Sets `soil_below` of two maps that are compared, of both or of neither: the texture of one has
/// nothing in common with the luminance of the other.
void tellSoil(GridMap& fixed, GridMap& moving);

/// Per cell the luminance of the soil over its mean within some cells, in its deviations there; 0
/// where Excess Green is not below `soil_below` or nothing was seen. A shadow multiplies both, and
/// its borders are wider than that.
Raster<float> soilTexture(const GridMap& map, float soil_below);

}  // namespace agricolmap::map
