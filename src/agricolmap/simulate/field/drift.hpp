// Drift of the robot's path: a smooth bending and stretching of the strip that no affine undoes.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace agricolmap::simulate {

/// The error of dead reckoning along a straight path: heading and speed errors that wander, summed
/// up. The displacement is zero in the middle of the path.
class Drift {
 public:
  /// The largest displacement is `share · length` [m].
  Drift(double length, double share, std::uint64_t seed);
  /// Displacement of a point given by metres along the path from its beginning, metres to its left.
  Eigen::Vector3d at(double along, double aside) const;

 private:
  double step_;
  std::vector<Eigen::Vector3d> nodes_;
};

}  // namespace agricolmap::simulate
