// What of a cloud is seen from above: the part of the grid map that a shared map is made of.
#pragma once

#include <Eigen/Core>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::fuse {

/// Points no further below the highest of their cell than this are its surface [m].
inline constexpr double kSkin = 0.02;

/// Side of the cells of which nearly all hold a point, for points this far apart [m]: a tenth more,
/// rounded up to a number that is easily said, between 5 mm and 1 m.
double cellFor(double spacing);

/// The map of what lies on top: height, Excess Green and colour are means of the points within
/// kSkin of the highest of the cell, one point alone far above all others left out; `weight` is the
/// number of all points. `shift`: the cloud's local coordinates → those of the frame [m]. Two
/// passes.
map::GridMap surfaceMap(const PointStream& cloud, const Eigen::Vector3d& shift,
                        const GridFrame& frame);

/// The weight of a cell that has no point and is filled from those around it.
inline constexpr float kBetween = 1e-3F;

/// Cells without a point that have at least five of their eight neighbours become the mean of
/// these: where points are about as far apart as cells are wide, chance leaves cells empty that are
/// no holes.
void fillBetween(map::GridMap& map);

/// Blocks of `factor` × `factor` cells as one: means over the cells that are filled.
map::GridMap coarsened(const map::GridMap& fine, int factor);

}  // namespace agricolmap::fuse
