// Where the initial guess allows a point to move.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/core/random.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::paper {

/// The maps p = c + t + M·(q − c), M = R(yaw)·A·diag(s)·Aᵀ, that PriorUncertainty allows: c the
/// centre, A the scale axes, |t| ≤ translation. Displacements therefore spread with the lever arm.
/// Where the moving map was warped before it is matched, its points q' = warp·q stand for q.
class Reach {
 public:
  explicit Reach(const SearchSpace& space,
                 const Eigen::Affine2d& warp = Eigen::Affine2d::Identity());

  /// Fixed point of moving point `q` under a random allowed map.
  Eigen::Vector2d sampleForward(const Eigen::Vector2d& q, Random& random) const;
  /// Moving point of fixed point `p` under a random allowed map.
  Eigen::Vector2d sampleBackward(const Eigen::Vector2d& p, Random& random) const;
  /// Bounding box of all fixed points that `q` can have.
  map::Box2 forwardBox(const Eigen::Vector2d& q) const;
  /// Bounding box of all moving points that `p` can have.
  map::Box2 backwardBox(const Eigen::Vector2d& p) const;

 private:
  Eigen::Matrix2d randomLinear(Random& random) const;
  Eigen::Vector2d randomShift(Random& random) const;
  template <typename Map>
  map::Box2 boxOver(const Map& map) const;

  /// A linear map at a limit of what is allowed, and its inverse.
  struct Extreme {
    Eigen::Matrix2d linear;
    Eigen::Matrix2d inverse;
  };

  SearchSpace space_;
  Eigen::Affine2d warp_;
  Eigen::Affine2d unwarp_;
  double yaw_;
  std::vector<Extreme> extremes_;  ///< they span the boxes of all points
};

}  // namespace agricolmap::paper
