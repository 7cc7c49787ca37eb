#include "agricolmap/paper/cpd/cpd_fit.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "agricolmap/core/scaled_rotation.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::paper {
namespace {

/// Least variance of the points in any direction [m²]: thinner sets are lines.
constexpr double kMinVariance = 1e-4;
/// Least variance of the heights for a vertical scale [m²].
constexpr double kMinHeightVariance = 1e-4;

/// Rotation, and one scale if `with_scale` (Umeyama 1991 in two dimensions).
Eigen::Matrix2d fitSimilarity(const Eigen::Matrix2d& cross, const Eigen::Matrix2d& moving2,
                              bool with_scale) {
  const double along = cross.trace();
  const double across = cross(1, 0) - cross(0, 1);
  const double scale = with_scale ? std::hypot(along, across) / moving2.trace() : 1.0;
  return scale * rotation2(std::atan2(across, along));
}

}  // namespace

void CpdMoments::add(double w, const Eigen::Vector3d& y, const Eigen::Vector3d& x) {
  weight += w;
  moving += w * y;
  fixed += w * x;
  moving2 += w * y.head<2>() * y.head<2>().transpose();
  cross += w * x.head<2>() * y.head<2>().transpose();
  moving_zz += w * y.z() * y.z();
  cross_zz += w * x.z() * y.z();
}

CpdMoments& CpdMoments::operator+=(const CpdMoments& other) {
  weight += other.weight;
  moving += other.moving;
  fixed += other.fixed;
  moving2 += other.moving2;
  cross += other.cross;
  moving_zz += other.moving_zz;
  cross_zz += other.cross_zz;
  return *this;
}

std::optional<CpdPose> fitCpdPose(const CpdMoments& moments, CpdModel model,
                                  const Eigen::Matrix2d& scale_axes, bool vertical_scale) {
  if (!(moments.weight > 0.0)) return std::nullopt;
  const double scale = 1.0 / moments.weight;
  const Eigen::Vector3d y = scale * moments.moving;
  const Eigen::Vector3d x = scale * moments.fixed;
  const Eigen::Matrix2d moving2 = scale * moments.moving2 - y.head<2>() * y.head<2>().transpose();
  const Eigen::Matrix2d cross = scale * moments.cross - x.head<2>() * y.head<2>().transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(moving2, Eigen::EigenvaluesOnly);
  if (!(spread.eigenvalues()(0) > kMinVariance)) return std::nullopt;
  CpdPose pose;
  switch (model) {
    case CpdModel::kAffine:
      pose.plane.linear() = cross * moving2.inverse();
      break;
    case CpdModel::kScaled: {
      const Eigen::Matrix2d axes = orthonormalAxes(scale_axes);
      const auto fit = fitYawScales(cross * axes, axes.transpose() * moving2 * axes, axes);
      if (!fit) return std::nullopt;
      pose.plane.linear() = fit->linear(axes);
      break;
    }
    case CpdModel::kSimilarity:
    case CpdModel::kRigid:
      pose.plane.linear() = fitSimilarity(cross, moving2, model == CpdModel::kSimilarity);
      break;
  }
  if (!pose.plane.linear().allFinite() || pose.plane.linear().determinant() <= 0.0) {
    return std::nullopt;
  }
  pose.plane.translation() = x.head<2>() - pose.plane.linear() * y.head<2>();
  const double variance = scale * moments.moving_zz - y.z() * y.z();
  if (vertical_scale && variance > kMinHeightVariance) {
    pose.height_scale = (scale * moments.cross_zz - x.z() * y.z()) / variance;
  }
  pose.height_offset = x.z() - pose.height_scale * y.z();
  return pose;
}

}  // namespace agricolmap::paper
