#include "agricolmap/paper/cpd/cpd_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace agricolmap::paper {
namespace {

/// Least variance of the points in any direction [m²]: thinner sets are lines.
constexpr double kMinVariance = 1e-4;

}  // namespace

void CpdMoments::add(double w, const Eigen::Vector3d& y, const Eigen::Vector3d& x) {
  weight += w;
  moving += w * y;
  fixed += w * x;
  moving2 += w * y.head<2>() * y.head<2>().transpose();
  cross += w * x.head<2>() * y.head<2>().transpose();
}

CpdMoments& CpdMoments::operator+=(const CpdMoments& other) {
  weight += other.weight;
  moving += other.moving;
  fixed += other.fixed;
  moving2 += other.moving2;
  cross += other.cross;
  return *this;
}

std::optional<CpdPose> fitCpdPose(const CpdMoments& moments) {
  if (!(moments.weight > 0.0)) return std::nullopt;
  const double scale = 1.0 / moments.weight;
  const Eigen::Vector3d y = scale * moments.moving;
  const Eigen::Vector3d x = scale * moments.fixed;
  const Eigen::Matrix2d moving2 = scale * moments.moving2 - y.head<2>() * y.head<2>().transpose();
  const Eigen::Matrix2d cross = scale * moments.cross - x.head<2>() * y.head<2>().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(moving2, Eigen::EigenvaluesOnly);
  if (!(spread.eigenvalues()(0) > kMinVariance)) return std::nullopt;
  CpdPose pose;
  pose.plane.linear() = cross * moving2.inverse();
  if (!pose.plane.linear().allFinite() || pose.plane.linear().determinant() <= 0.0) {
    return std::nullopt;
  }
  pose.plane.translation() = x.head<2>() - pose.plane.linear() * y.head<2>();
  pose.height_offset = x.z() - y.z();
  return pose;
}

}  // namespace agricolmap::paper
