// Transforms: `target_from_source * point_in_source = point_in_target`. Metres and radians.
#pragma once

#include <Eigen/Geometry>

namespace agricolmap {

/// The parts of a horizontal linear map M = R(yaw) · [1 k; 0 1] · diag(scale_x, scale_y):
/// scales act on the moving file's axes, as directional scale errors do.
struct HorizontalParts {
  double yaw = 0.0;      ///< heading of the moving x axis [rad], (−π, π]
  double scale_x = 1.0;  ///< scale along the moving file's x axis
  double scale_y = 1.0;  ///< scale along the moving file's y axis
  double shear = 0.0;    ///< k, zero when the scaled axes stay perpendicular
};

/// Splits a 2×2 linear map with positive determinant; exact inverse of composeHorizontal.
HorizontalParts splitHorizontal(const Eigen::Matrix2d& linear);
Eigen::Matrix2d composeHorizontal(const HorizontalParts& parts);

/// A rotation about z [rad].
Eigen::Matrix2d rotation2(double yaw);

/// Nearest rotation to a linear map (polar decomposition), for the paper's rotation error.
Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& linear);

}  // namespace agricolmap
