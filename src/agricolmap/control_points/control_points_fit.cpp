#include "agricolmap/control_points/control_points_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/scaled_rotation.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::control_points {
namespace {

using Matrix5d = Eigen::Matrix<double, 5, 5>;
using Vector5d = Eigen::Matrix<double, 5, 1>;

constexpr int kSteps = 100;
constexpr double kStill = 1e-12;     ///< a step in radians and scales at which nothing moves
constexpr double kConverged = 1e-8;  ///< the largest last step of a fit that counts

/// Below this share of the widest spread, what is across cannot be told from noise.
constexpr double kLeastVolume = 1e-6;

Eigen::Vector3d weightedMean(const std::vector<Eigen::Vector3d>& places,
                             std::span<const double> weights) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    sum += weights[i] * places[i];
    total += weights[i];
  }
  return sum / total;
}

Eigen::Matrix3d cross(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Rotation and horizontal scales as seen from above, which are those in space but for the tilt.
std::optional<ScaledRotation> fromAbove(const PairPlaces& pairs, std::span<const double> weights) {
  std::vector<Match> matches;
  matches.reserve(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    matches.push_back({pairs.moving[i].head<2>(), pairs.fixed[i].head<2>()});
  }
  return fitScaledRotation(matches, weights, Eigen::Matrix2d::Identity());
}

/// Gauss-Newton over a rotation in space and two scales; in closed form there is only the problem
/// in the plane, where it starts. With y = Rᵀp and R ← R·exp(δ), the residual is y − Sq + [Sq]ₓδ −
/// (q₁, 0, 0)·δs₁ − (0, q₂, 0)·δs₂, about the means, which takes the shift out.
std::optional<Eigen::Affine3d> fitScales(const PairPlaces& pairs, std::span<const double> weights) {
  const auto start = fromAbove(pairs, weights);
  if (!start) return std::nullopt;
  const Eigen::Vector3d mean_q = weightedMean(pairs.moving, weights);
  const Eigen::Vector3d mean_p = weightedMean(pairs.fixed, weights);
  Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(start->yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Eigen::Vector3d scale(start->scale.x(), start->scale.y(), 1.0);
  double step = 1.0;
  for (int k = 0; k < kSteps && step > kStill; ++k) {
    Matrix5d normal = Matrix5d::Zero();
    Vector5d right = Vector5d::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (!(weights[i] > 0.0)) continue;
      const Eigen::Vector3d q = pairs.moving[i] - mean_q;
      const Eigen::Vector3d scaled = scale.cwiseProduct(q);
      Eigen::Matrix<double, 3, 5> jacobian = Eigen::Matrix<double, 3, 5>::Zero();
      jacobian.leftCols<3>() = -cross(scaled);
      jacobian(0, 3) = q.x();
      jacobian(1, 4) = q.y();
      normal += weights[i] * jacobian.transpose() * jacobian;
      right += weights[i] * jacobian.transpose() *
               (rotation.transpose() * (pairs.fixed[i] - mean_p) - scaled);
    }
    const Vector5d change = normal.ldlt().solve(right);
    step = change.norm();
    if (!std::isfinite(step)) return std::nullopt;
    const double angle = change.head<3>().norm();
    if (angle > 0.0) {
      rotation *= Eigen::AngleAxisd(angle, change.head<3>() / angle).toRotationMatrix();
    }
    scale.head<2>() += change.tail<2>();
  }
  if (step > kConverged || !(scale.minCoeff() > 0.0)) return std::nullopt;
  Eigen::Affine3d fit = Eigen::Affine3d::Identity();
  fit.linear() = rotation * scale.asDiagonal();
  fit.translation() = mean_p - fit.linear() * mean_q;
  return fit;
}

}  // namespace

std::optional<Eigen::Affine3d> fitPairs(const PairPlaces& pairs, std::span<const double> weights,
                                        ControlModel model) {
  if (model == ControlModel::kScales) return fitScales(pairs, weights);
  if (std::count_if(weights.begin(), weights.end(), [](double w) { return w > 0.0; }) < 4) {
    return std::nullopt;
  }
  const PairSpread spread = spreadOf(pairs, weights);
  if (!(spread.thinnest > kLeastVolume * spread.widest)) return std::nullopt;
  Eigen::Affine3d fit = fitAffine(pairs.moving, pairs.fixed, weights);
  if (!(fit.linear().determinant() > 0.0)) return std::nullopt;
  return fit;
}

ControlParts splitLinear(const Eigen::Matrix3d& linear) {
  // Gram-Schmidt, which keeps the moving x axis and the plane of x and y.
  Eigen::Matrix3d r;
  r.col(0) = linear.col(0).normalized();
  r.col(2) = linear.col(0).cross(linear.col(1)).normalized();
  r.col(1) = r.col(2).cross(r.col(0));
  const Eigen::Matrix3d u = r.transpose() * linear;
  ControlParts parts;
  parts.scale = u.diagonal();
  parts.shear = {u(0, 1) / u(1, 1), u(0, 2) / u(2, 2), u(1, 2) / u(2, 2)};
  parts.angles = {std::atan2(r(2, 1), r(2, 2)), std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0))),
                  std::atan2(r(1, 0), r(0, 0))};
  return parts;
}

PairSpread spreadOf(const PairPlaces& pairs, std::span<const double> weights) {
  const Eigen::Vector3d mean = weightedMean(pairs.moving, weights);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double total = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d q = pairs.moving[i] - mean;
    covariance += weights[i] * q * q.transpose();
    total += weights[i];
  }
  covariance /= total;
  const auto deviation = [](double variance) { return std::sqrt(std::max(0.0, variance)); };
  const Eigen::Vector2d flat = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(
                                   covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly)
                                   .eigenvalues();
  const Eigen::Vector3d solid =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance, Eigen::EigenvaluesOnly)
          .eigenvalues();
  return {deviation(flat[0]), deviation(flat[1]), deviation(solid[0]), deviation(solid[2])};
}

}  // namespace agricolmap::control_points
