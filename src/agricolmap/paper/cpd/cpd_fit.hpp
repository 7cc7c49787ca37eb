// The maximisation step of coherent point drift: weighted least squares in closed form.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "agricolmap/paper/cpd/cpd.hpp"

namespace agricolmap::paper {

/// Weighted sums over pairs (moving y, fixed x) that the fit needs.
struct CpdMoments {
  double weight = 0.0;
  Eigen::Vector3d moving = Eigen::Vector3d::Zero();   ///< Σ W·y
  Eigen::Vector3d fixed = Eigen::Vector3d::Zero();    ///< Σ W·x
  Eigen::Matrix2d moving2 = Eigen::Matrix2d::Zero();  ///< Σ W·y·yᵀ, horizontal
  Eigen::Matrix2d cross = Eigen::Matrix2d::Zero();    ///< Σ W·x·yᵀ, horizontal

  void add(double w, const Eigen::Vector3d& y, const Eigen::Vector3d& x);
  CpdMoments& operator+=(const CpdMoments& other);
};

/// The pose with the least Σ W·|x − pose(y)|²; nothing when the points do not determine
/// it (fewer than two directions, no weight).
std::optional<CpdPose> fitCpdPose(const CpdMoments& moments);

}  // namespace agricolmap::paper
