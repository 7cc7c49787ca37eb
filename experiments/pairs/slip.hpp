// Strips of which a part is displaced in the file, as by an odometry slip.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap::experiments {

struct Slip {
  double metres = 0.0;  ///< of the field, horizontal
  double share = 0.5;   ///< of the strip's length that comes after it, at most one half
  bool along = false;   ///< along the strip instead of across
  /// The other end, too, by as much the other way: what is left is the middle. `share` at most 1/3.
  bool twice = false;
};

/// Displaces one end of the strip, which of the two and to which side being drawn. Each point keeps
/// its own truth; the best affine becomes that of the part that stays. Returns where on the path
/// the slips are, UAV file [m].
std::vector<Eigen::Vector3d> displacePart(simulate::SimulatedStrip& strip, const Slip& slip,
                                          const simulate::SimulationOptions& options);

}  // namespace agricolmap::experiments
