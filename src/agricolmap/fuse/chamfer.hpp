// Distances in a raster, by chamfers.
#pragma once

#include <cstdint>

#include "agricolmap/core/raster.hpp"

namespace agricolmap::fuse {

/// Of every cell's middle to that of the nearest cell that is set, through neighbours straight
/// (1 cell) and across (1.4): too long by at most 8 %. `beyond`: what the cells around the raster
/// have, 0 as if they were set. The greatest float where there is no such cell.
Raster<float> chamferDistance(const Raster<std::uint8_t>& set, double cell, float beyond);

}  // namespace agricolmap::fuse
