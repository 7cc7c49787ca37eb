// How large a registration's error is against the covariance that it states.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace agricolmap::campaign {

/// A pose's horizontal error moves a point at q from `centre` by
/// (δx, δy) + δψ·(−q_y, q_x) + δa·u(u·q) + δb·v(v·q), with u, v the columns of `axes`.
struct StatedUncertainty {
  Eigen::Matrix<double, 5, 5> covariance;  ///< of (δx, δy [m], δψ [rad], δa, δb)
  Eigen::Vector2d centre;                  ///< [m]
  Eigen::Matrix2d axes;
};

struct PoseError {
  Eigen::Matrix<double, 5, 1> parameters;  ///< that explain the displacements best
  double mahalanobis2 = 0.0;               ///< of all five, over the covariance
  double centre_mahalanobis2 = 0.0;        ///< of the shift alone
};

/// `estimated` and `true_places`: where points of the strip are laid and where they belong, in the
/// frame of the covariance [m]. Needs three points that are not on a line.
PoseError poseError(const std::vector<Eigen::Vector2d>& estimated,
                    const std::vector<Eigen::Vector2d>& true_places,
                    const StatedUncertainty& uncertainty);

}  // namespace agricolmap::campaign
