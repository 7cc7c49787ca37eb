// Where the moving map may lie: what a search hands on to the refinement.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace agricolmap {

/// A point of the moving map and where it lies in the fixed map, levelled frames [m].
struct Match {
  Eigen::Vector2d moving;
  Eigen::Vector2d fixed;
};

/// One hypothesis of where the moving map lies.
struct Placement {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();  ///< levelled moving → levelled fixed
  double score = 0.0;  ///< of its own search; larger is better, comparable within one
  /// The coherent pairs that speak for it, where it was found by matching points: the preliminary
  /// affine (paper Eq. 3) is estimated from them. Empty where a search found the pose as a whole.
  std::vector<Match> matches;
};

}  // namespace agricolmap
