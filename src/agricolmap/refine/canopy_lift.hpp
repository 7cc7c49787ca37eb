// How far a drone's blur lifts the ground between plants. A drone's surface is the true one,
// blurred by centimetres, and often lower; a robot sees into gaps. What the robot's surface would
// look like from the drone tells how high gaps would stand there.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/refine/ground_cells.hpp"

namespace agricolmap::refine {

/// Of the moving map's canopy, as the fixed map seems to see it.
struct CanopyLift {
  double blur = 0.0;         ///< deviation of the Gaussian that explains the fixed surface best [m]
  double correlation = 0.0;  ///< of the two surfaces then
  double gain = 1.0;  ///< how tall the fixed map sees what the moving map sees as 1 m of canopy
  /// Per cell: how much more than the moving map's height the fixed map's should be, because
  /// neighbouring plants are blurred into it [m].
  std::vector<double> lift;
};

/// `plane`: offset and slope that lay the moving map's ground on the fixed map's, about the origin
/// of the cells' places: fixed height = moving height + plane · (1, x, y). `about`: that origin in
/// the fixed frame [m].
CanopyLift predictLift(const map::GridMap& fixed, const map::GridMap& moving,
                       const GroundModel& under_moving, const Eigen::Affine2d& pose,
                       const std::vector<GroundCell>& cells, const Eigen::Vector3d& plane,
                       const Eigen::Vector2d& about);

}  // namespace agricolmap::refine
