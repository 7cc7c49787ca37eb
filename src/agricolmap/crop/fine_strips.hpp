// Maps that are finer where robots were: plants are counted in the cells that show them best.
#pragma once

#include <vector>

#include "agricolmap/crop/field_layers.hpp"

namespace agricolmap::crop {

/// What a strip shows in cells of its own.
struct FineStrip {
  GridFrame frame;       ///< about the layers' origin [m]
  Raster<float> exg;     ///< NaN where it shows nothing
  Raster<float> height;  ///< above the ground
};

/// Cuts the layers' cells into those of the strips, or as fine as memory allows on a large field,
/// and puts the strips' values in place of the map's, where they have any.
void refine(FieldLayers& layers, const std::vector<FineStrip>& strips);

}  // namespace agricolmap::crop
