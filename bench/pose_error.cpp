#include "pose_error.hpp"

#include <Eigen/Cholesky>
#include <cstddef>

namespace agricolmap::campaign {

PoseError poseError(const std::vector<Eigen::Vector2d>& estimated,
                    const std::vector<Eigen::Vector2d>& true_places,
                    const StatedUncertainty& uncertainty) {
  using Matrix5 = Eigen::Matrix<double, 5, 5>;
  using Vector5 = Eigen::Matrix<double, 5, 1>;
  Matrix5 normal = Matrix5::Zero();
  Vector5 right = Vector5::Zero();
  for (std::size_t i = 0; i < estimated.size(); ++i) {
    const Eigen::Vector2d q = estimated[i] - uncertainty.centre;
    Eigen::Matrix<double, 2, 5> jacobian;
    jacobian.leftCols<2>().setIdentity();
    jacobian.col(2) << -q.y(), q.x();
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector2d direction = uncertainty.axes.col(axis);
      jacobian.col(3 + axis) = direction * direction.dot(q);
    }
    normal += jacobian.transpose() * jacobian;
    right += jacobian.transpose() * (estimated[i] - true_places[i]);
  }
  PoseError error;
  error.parameters = normal.ldlt().solve(right);
  error.mahalanobis2 = error.parameters.dot(uncertainty.covariance.ldlt().solve(error.parameters));
  const Eigen::Matrix2d shift = uncertainty.covariance.topLeftCorner<2, 2>();
  const Eigen::Vector2d off = error.parameters.head<2>();
  error.centre_mahalanobis2 = off.dot(shift.ldlt().solve(off));
  return error;
}

}  // namespace agricolmap::campaign
