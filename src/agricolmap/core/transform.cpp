#include "agricolmap/core/transform.hpp"

#include <Eigen/SVD>
#include <cmath>

namespace agricolmap {

HorizontalParts splitHorizontal(const Eigen::Matrix2d& linear) {
  HorizontalParts parts;
  parts.yaw = std::atan2(linear(1, 0), linear(0, 0));
  parts.scale_x = linear.col(0).norm();
  const Eigen::Matrix2d rest = rotation2(-parts.yaw) * linear;
  parts.scale_y = rest(1, 1);
  parts.shear = rest(0, 1) / rest(1, 1);
  return parts;
}

Eigen::Matrix2d composeHorizontal(const HorizontalParts& parts) {
  Eigen::Matrix2d rest;
  rest << parts.scale_x, parts.shear * parts.scale_y, 0.0, parts.scale_y;
  return rotation2(parts.yaw) * rest;
}

Eigen::Matrix2d rotation2(double yaw) { return Eigen::Rotation2Dd(yaw).toRotationMatrix(); }

Eigen::Matrix3d nearestRotation(const Eigen::Matrix3d& linear) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(linear, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d rotation = svd.matrixU() * svd.matrixV().transpose();
  if (rotation.determinant() < 0.0) {
    Eigen::Matrix3d u = svd.matrixU();
    u.col(2) *= -1.0;
    rotation = u * svd.matrixV().transpose();
  }
  return rotation;
}

}  // namespace agricolmap
