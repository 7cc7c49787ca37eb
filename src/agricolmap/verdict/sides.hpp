// Two passes of a robot in one file, side by side: each side of the strip is one, but what dead
// reckoning made of the second is not what it made of the first.
#pragma once

#include <optional>

#include "agricolmap/verdict/evidence.hpp"

namespace agricolmap::verdict {

/// How far the strip's two sides lie apart against the whole, median along the strip [m]; nothing
/// where they do not, beyond what blocks one behind the other on either side differ by.
std::optional<double> sidesApart(const Evidence& evidence);

}  // namespace agricolmap::verdict
