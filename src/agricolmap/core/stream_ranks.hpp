// What would need all coordinates of a cloud in order, of points that pass by.
#pragma once

#include <cstddef>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/point_stream.hpp"

namespace agricolmap {

/// The box that is left when along each axis the `tail` least and the `tail` largest local
/// coordinates [m] are taken off: exact to the bit, in two passes and 3 MiB. Throws UsageError when
/// nothing would be left, and what the stream throws.
Box3 boxWithoutTails(const PointStream& points, std::size_t tail);

}  // namespace agricolmap
