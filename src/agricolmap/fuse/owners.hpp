// Which source a cell of the shared map comes from.
#pragma once

#include <cstdint>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/fuse/layers.hpp"
#include "agricolmap/fuse/strip_cells.hpp"

namespace agricolmap::fuse {

/// What decides between strips that saw the same cell.
struct Claim {
  const StripCells* cells = nullptr;
  std::uint16_t code = kNoSource;
  std::int32_t date = 0;
  double error = 0.0;  ///< expected RMS, plane and height together [m]
};

/// Strips own what they have seen: of several the latest, then the one that has most around the
/// cell (0.3 m are enough), then the one with the least error, then the least code. So their order
/// does not matter. The fixed cloud has the rest, where it has anything.
Raster<std::uint16_t> ownersOf(const map::GridMap& fixed, const std::vector<Claim>& claims);

}  // namespace agricolmap::fuse
