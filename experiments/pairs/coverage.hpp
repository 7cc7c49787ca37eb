// Does a registration err by as much as it says? Its error in the parameters and in units of its
// own uncertainty.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/verdict/uncertainty.hpp"

namespace agricolmap::experiments {

/// What a registration states about its own error.
struct StatedError {
  verdict::PoseUncertainty pose;
  Eigen::Affine3d levelled_from_fixed =
      Eigen::Affine3d::Identity();  ///< fixed local → levelled [m]
};

struct Coverage {
  /// What the true best affine differs by from the found one: the parameters of PoseUncertainty.
  Eigen::Matrix<double, 5, 1> error = Eigen::Matrix<double, 5, 1>::Zero();
  double pose_distance2 =
      0.0;  ///< squared Mahalanobis distance, χ² of 5 if the covariance is right
  double shift_distance2 = 0.0;   ///< of the shift at the strip's centre alone: χ² of 2
  double height_distance2 = 0.0;  ///< of the mean height: χ² of 1
  double height_error = 0.0;      ///< by how much the strip is too high, on average [m]
};

/// Of `found` (moving file → fixed file). Nothing for fewer than five points.
std::optional<Coverage> coverageOf(const Eigen::Affine3d& found, const StatedError& stated,
                                   const Cloud& fixed, const Cloud& moving,
                                   const evaluate::Truth& truth);

}  // namespace agricolmap::experiments
