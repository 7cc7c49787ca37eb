#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "agricolmap/deform/deform.hpp"

namespace agricolmap::deform {
namespace {

/// Places that the spline goes through for each of its nodes, and how little holds it where there
/// are none.
constexpr int kPerNode = 6;
constexpr double kSlack = 1e-6;

}  // namespace

Bend bendThrough(const Path& path, const Eigen::Affine2d& pose, double node, double deviation,
                 const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& laid) {
  const SplineBasis basis(path.length(), node);
  const int places = kPerNode * basis.size();
  Eigen::MatrixXd normal = kSlack * Eigen::MatrixXd::Identity(basis.size(), basis.size());
  Eigen::MatrixX3d right = Eigen::MatrixX3d::Zero(basis.size(), 3);
  double sum2 = 0.0, most = 0.0;
  for (int k = 0; k <= places; ++k) {
    const double along = path.length() * k / places;
    const Eigen::Vector2d on_path = path.point(along);
    const Eigen::Vector3d point(on_path.x(), on_path.y(), 0.0);
    Eigen::Vector3d displacement = laid(point) - point;
    displacement.head<2>() = pose.linear() * displacement.head<2>();
    const SplineBasis::At at = basis.at(along);
    for (int i = 0; i < 4; ++i) {
      right.row(at.first + i) += at.value[i] * displacement.transpose();
      for (int j = 0; j < 4; ++j) normal(at.first + i, at.first + j) += at.value[i] * at.value[j];
    }
    sum2 += displacement.head<2>().squaredNorm();
    most = std::max(most, displacement.head<2>().norm());
  }
  Bend bend{.deformation = Deformation(path, pose.linear().colwise().normalized(), basis),
            .pose = pose,
            .rms = std::sqrt(sum2 / (places + 1)),
            .most = most};
  bend.deformation.coefficients = normal.ldlt().solve(right);
  const Eigen::Index unknowns = unknownOf(basis.size());
  bend.deformation.covariance =
      deviation * deviation * Eigen::MatrixXd::Identity(unknowns, unknowns);
  bend.deformation.height_deviation = deviation;
  return bend;
}

}  // namespace agricolmap::deform
