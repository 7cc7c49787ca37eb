// Points of the old formats 0 to 5 as those that LAS 1.4 has instead, 6 to 8.
#pragma once

#include <cstddef>
#include <vector>

#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {

/// The same file with points of format 6, 7 or 8: what has colours becomes 7, what has near
/// infrared 8. Extra bytes stay behind the rest. Wave packets have no place there.
LasOutline lifted(LasOutline outline);

/// The standard 30 bytes of a record, as point format 6 has them.
void liftStandard(const std::byte* record, const LasLayout& layout, std::byte* to);

/// Records of `from` in the layout `to` of such an outline. Scan angles become steps of 0.006°, and
/// class 12, by which the old formats tell overlap, becomes the flag for it and class 1.
std::vector<std::byte> lifted(const std::vector<std::byte>& records, const LasLayout& from,
                              const LasLayout& to);

}  // namespace agricolmap::io
