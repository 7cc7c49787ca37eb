// Where a cloud's points are, seen from above: what the size of its map, the point that it is
// turned about and the size of its cells go by.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

struct Footprint {
  Box2 box;                  ///< bounds of the points that make up the map [m]
  std::size_t points = 0;    ///< in the box
  std::size_t left_out = 0;  ///< beside it
  double area = 0.0;         ///< that holds points, by bins of half a metre [m²]

  /// Mean distance between neighbouring points, seen from above [m]; bins can tell it up to half a
  /// metre.
  double spacing() const;
};

/// The footprint of `cloud` in the levelled frame. Groups of points that are more than a metre from
/// all others are left out where each holds less than a thousandth of the points and all together
/// no more than a hundredth: a bird, a passer-by, points mismatched far away. Parts that hold more
/// are the map's, however far apart, and in a cloud so sparse that its points are all on their own
/// nothing is left out. Without such groups `box` is the bounds of all points.
/// Two passes, and two more for each time that something is left out.
Footprint footprintOf(const PointStream& cloud, const Eigen::Affine3d& levelled_from_local);
Footprint footprintOf(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local);

}  // namespace agricolmap::map
