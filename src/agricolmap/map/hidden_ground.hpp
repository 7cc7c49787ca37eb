// Ground that a robot's camera does not see because a plant stands before it, filled in. Of cells
// behind a plant only what rises above the line of sight has points, so the map shows them greener
// and higher than they are, always on the far side of the rows: on strips of simulated crops that
// made the refinement's scale across the strip up to 2 % too small.
#pragma once

#include "agricolmap/core/options.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

struct HiddenGroundOptions {
  bool fill = true;
  double radius = 0.25;  ///< half side of the square whose cells say what is usual around [m]
  double whole = 0.5;    ///< a cell with this share of the usual number of points was seen whole
  double bare = 0.3;     ///< bare ground: below this share of the way from soil to plant
};
void listOptions(OptionTable& table, HiddenGroundOptions& options);

/// 1 where the map shows bare ground: least green by `share` of the way from the map's tenth to its
/// nine tenths, or, without colours, least high; else 0.
Raster<float> bareGround(const GridMap& map, double share);

/// A copy of `map` in which the part of each cell that has no points, for its share of the usual
/// number of points around, has Excess Green and height of the bare ground around. Cells far from
/// all points stay empty, as do those with no bare ground around. Where filled cells hold fewer
/// than 4 points on average the map stays as it is, as their number says nothing then: a cloud that
/// was thinned to a point per voxel of a cell's size does not tell what was seen. Colours stay,
/// too.
///
/// Bare is `bareGround` by `HiddenGroundOptions::bare`. Under a canopy that closes that is its
/// shade, and little changes there: soybean came out as well without the fill, tall maize better
/// (docs/accuracy.md).
GridMap withHiddenGround(const GridMap& map, const HiddenGroundOptions& options);

}  // namespace agricolmap::map
