// How far each block of the strip, alone, would rather be moved against a pose.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::verdict {

/// A block's own shift against the pose.
struct BlockShift {
  bool usable = false;  ///< the fixed map has seen it, too, and their textures fit
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< its cells' middle, fixed frame [m]
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();  ///< [m]
  std::size_t cells = 0;                            ///< that the moving map has seen
};

/// Shifts of about square blocks of side near `side` [m] under `pose`, those of them in which the
/// moving map has seen enough. `fixed`, `moving`: of the same cell size; a block is looked for up
/// to 2.5 cells away.
std::vector<BlockShift> shiftBlocks(const map::SignalMap& fixed, const map::SignalMap& moving,
                                    const Eigen::Affine2d& pose, double side);

}  // namespace agricolmap::verdict
