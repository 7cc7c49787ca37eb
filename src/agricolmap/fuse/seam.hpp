// The fixed cloud's heights led to those of the strips, so that no step is left at their borders.
#pragma once

#include <optional>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/fuse/drone_heights.hpp"
#include "agricolmap/fuse/strip_cells.hpp"

namespace agricolmap::fuse {

/// What to add to the fixed cloud's heights [m]: the bias, where there is one, and towards a strip,
/// over `seam` metres, what is left between the two along its border.
Raster<float> heightCorrection(const FixedHeights& fixed, const std::optional<HeightBias>& bias,
                               const std::vector<const StripCells*>& strips, double seam);

}  // namespace agricolmap::fuse
