// Two maps on one grid: the coarser map's, the finer map averaged over its cells.
#pragma once

#include <cstdint>
#include <optional>

#include "agricolmap/core/raster.hpp"

namespace agricolmap::change {

/// Of two frames about one origin: the cells of the coarser one (of `a` where both are alike) that
/// lie within both; nothing where there are none.
std::optional<GridFrame> commonGrid(const GridFrame& a, const GridFrame& b);

/// Whether two frames have the same cells.
bool sameGrid(const GridFrame& a, const GridFrame& b);

/// Mean over the area of each cell of `to`; NaN where less than half of that is known. The cells of
/// `to` are not smaller than those of `from`.
Raster<float> areaMean(const Raster<float>& values, const GridFrame& from, const GridFrame& to);

/// Root of the mean square over the area: errors of neighbours are taken to be one error, which no
/// mean makes smaller.
Raster<float> areaRms(const Raster<float>& values, const GridFrame& from, const GridFrame& to);

/// The code at the middle of each cell.
Raster<std::uint16_t> nearestCode(const Raster<std::uint16_t>& codes, const GridFrame& from,
                                  const GridFrame& to);

}  // namespace agricolmap::change
