// Blocks of points in which nothing is out of the ordinary, as nearly all are: taken as a whole, in
// loops that the compiler makes vectors of, instead of point by point.
#pragma once

#include "agricolmap/io/cloud/point_taking.hpp"

namespace agricolmap::io {

/// Takes all points of a block, as if one after the other: `taken` is replaced, `tally` gets the
/// block's colours and heights. False, with neither touched, where a point is not kept: it is not
/// finite, too far from the origin, at the height of holes, or its colour is outside the range.
bool takePlainBlock(const PointBlock& block, ColourKind kind, const Taking& taking, Tally& tally,
                    TakenPoints& taken);

}  // namespace agricolmap::io
