// Weighted least squares of the two models that control points are fitted with.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <vector>

#include "agricolmap/control_points/control_points.hpp"

namespace agricolmap::control_points {

/// Places of pairs, each side relative to a point near its middle [m].
struct PairPlaces {
  std::vector<Eigen::Vector3d> moving;
  std::vector<Eigen::Vector3d> fixed;
  std::size_t size() const { return moving.size(); }
};

/// Minimises Σ w·|p − R·S·q − t|² (paper Eq. 3) for the model of scales, Σ w·|p − M·q − t|² for the
/// affine. `weights` are one per pair. Nothing when the pairs with weight leave something open, or
/// when the best map mirrors.
std::optional<Eigen::Affine3d> fitPairs(const PairPlaces& pairs, std::span<const double> weights,
                                        ControlModel model);

/// Takes a linear map with positive determinant apart.
ControlParts splitLinear(const Eigen::Matrix3d& linear);

/// How the moving places with weight spread: deviations along the two main horizontal directions,
/// and along the thinnest and the widest direction in space [m].
struct PairSpread {
  double across = 0.0;  ///< horizontal, the smaller one
  double along = 0.0;   ///< horizontal, the larger one
  double thinnest = 0.0;
  double widest = 0.0;
};
PairSpread spreadOf(const PairPlaces& pairs, std::span<const double> weights);

}  // namespace agricolmap::control_points
