// Where the moving map may lie: what a search hands on to the refinement.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace agricolmap {

/// A point of the moving map and where it lies in the fixed map, levelled frames [m].
struct Match {
  Eigen::Vector2d moving;
  Eigen::Vector2d fixed;
};

/// One hypothesis of where the moving map lies.
struct Placement {
  std::vector<Match> matches;  ///< coherent pairs: what the affine is estimated from
  double score = 0.0;          ///< of its own association; larger is better, comparable within one
};

}  // namespace agricolmap
