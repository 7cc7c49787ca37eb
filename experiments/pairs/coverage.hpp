// Does a registration err by as much as it says? Its error in the parameters and in units of its
// own uncertainty.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::evaluate {

struct Coverage {
  /// What the true best affine differs by from the found one: the parameters of PoseUncertainty.
  Eigen::Matrix<double, 5, 1> error = Eigen::Matrix<double, 5, 1>::Zero();
  double pose_distance2 =
      0.0;  ///< squared Mahalanobis distance, χ² of 5 if the covariance is right
  double shift_distance2 = 0.0;   ///< of the shift at the strip's centre alone: χ² of 2
  double height_distance2 = 0.0;  ///< of the mean height: χ² of 1
};

/// χ² below which 90 % of the cases lie.
inline constexpr double kChi2At90Of5 = 9.236;
inline constexpr double kChi2At90Of2 = 4.605;
inline constexpr double kChi2At90Of1 = 2.706;

/// Nothing when the registration has no uncertainty.
std::optional<Coverage> coverageOf(const pipeline::Registration& registration, const Cloud& fixed,
                                   const Cloud& moving, const Truth& truth);

}  // namespace agricolmap::evaluate
