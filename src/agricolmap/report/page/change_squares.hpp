// The change of a field, square by square.
#pragma once

#include "agricolmap/io/vector/vector_layer.hpp"
#include "agricolmap/report/page/change_page.hpp"

namespace agricolmap::report {

/// Squares on round coordinates, of 1 m or as much more as leaves some hundreds of them: the shares
/// that rose and fell by more than their level of detection, the mean change [m] and the mean level
/// [m], which is what a mean must exceed when neighbours err as one; means of the other layers'
/// changes.
io::VectorLayer changeSquares(const ChangeGround& ground);

}  // namespace agricolmap::report
