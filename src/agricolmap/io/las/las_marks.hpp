// The marks of a point within its record of LAS.
#pragma once

#include <cstddef>

#include "agricolmap/io/cloud/point_marks.hpp"
#include "agricolmap/io/las/las_layout.hpp"

namespace agricolmap::io {

/// Of a record of any format.
PointMarks marksOf(const std::byte* record, const LasLayout& layout);

/// Into a record of the formats 6 to 10.
void storeMarks(const PointMarks& marks, std::byte* record);

}  // namespace agricolmap::io
