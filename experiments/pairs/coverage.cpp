#include "experiments/pairs/coverage.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace agricolmap::experiments {
namespace {

/// Points that are looked at, spread over the cloud.
constexpr std::size_t kMostPoints = 20000;

}  // namespace

std::optional<Coverage> coverageOf(const Eigen::Affine3d& found_transform,
                                   const StatedError& stated, const Cloud& fixed,
                                   const Cloud& moving, const evaluate::Truth& truth) {
  const verdict::PoseUncertainty& uncertainty = stated.pose;
  const Eigen::Affine3d levelled = stated.levelled_from_fixed * Eigen::Translation3d(-fixed.origin);
  const std::size_t step = std::max<std::size_t>(1, moving.size() / kMostPoints);
  using Parameters = Eigen::Matrix<double, 5, 1>;
  Eigen::Matrix<double, 5, 5> normal = Eigen::Matrix<double, 5, 5>::Zero();
  Parameters right = Parameters::Zero();
  double height = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < moving.size(); i += step) {
    const Eigen::Vector3d point = moving.filePoint(i);
    const Eigen::Vector3d found = levelled * (found_transform * point);
    // What the best affine leaves over is orthogonal to these parameters.
    const Eigen::Vector3d missing = levelled * (truth.best_affine * point) - found;
    const Eigen::Matrix<double, 2, 5> j = uncertainty.jacobian(found.head<2>());
    normal += j.transpose() * j;
    right += j.transpose() * missing.head<2>();
    height += missing.z();
    count += 1.0;
  }
  if (count < 5.0) return std::nullopt;
  Coverage coverage;
  coverage.error = normal.ldlt().solve(right);
  coverage.pose_distance2 = coverage.error.dot(uncertainty.covariance.ldlt().solve(coverage.error));
  const Eigen::Vector2d shift = coverage.error.head<2>();
  coverage.shift_distance2 =
      shift.dot(uncertainty.covariance.topLeftCorner<2, 2>().ldlt().solve(shift));
  coverage.height_error = -height / count;
  const double in_deviations = height / count / uncertainty.height_deviation;
  coverage.height_distance2 = in_deviations * in_deviations;
  return coverage;
}

}  // namespace agricolmap::experiments
