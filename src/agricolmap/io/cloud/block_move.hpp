// Many points moved at once.
#pragma once

#include <cstddef>

#include "agricolmap/io/cloud/point_move.hpp"

namespace agricolmap::io {

/// Moves points in place: what PointMove does to each, several at a time where it is an affine.
void moveAll(const PointMove& move, double* x, double* y, double* z, std::size_t count);

}  // namespace agricolmap::io
