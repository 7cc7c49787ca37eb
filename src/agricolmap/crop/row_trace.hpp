// Rows, straight or curved, followed from where the lattice says they are.
#pragma once

#include <vector>

#include "agricolmap/crop/row_lattice.hpp"
#include "agricolmap/crop/row_line.hpp"

namespace agricolmap::crop {

/// The centre lines of all rows, numbered across the field to the left of the lattice's heading;
/// all run along that heading. Each is followed by the greenness on it, through gaps and bends as
/// far as something grows.
std::vector<RowLine> traceRows(const CoarseGreen& field, const RowLattice& lattice,
                               const RowOptions& options);

}  // namespace agricolmap::crop
