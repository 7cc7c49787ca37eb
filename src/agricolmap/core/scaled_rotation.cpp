#include "agricolmap/core/scaled_rotation.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap {

Eigen::Matrix2d YawScales::linear(const Eigen::Matrix2d& axes) const {
  return rotation2(yaw) * axes * scale.asDiagonal() * axes.transpose();
}

Eigen::Vector3d YawScales::vector() const {
  return {yaw, std::log(scale.x()), std::log(scale.y())};
}

YawScales YawScales::fromVector(const Eigen::Vector3d& vector) {
  return {vector[0], {std::exp(vector[1]), std::exp(vector[2])}};
}

Eigen::Matrix2d orthonormalAxes(const Eigen::Matrix2d& axes) {
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(axes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

std::optional<YawScales> fitYawScales(const Eigen::Matrix2d& products,
                                      const Eigen::Matrix2d& spread, const Eigen::Matrix2d& axes) {
  const double handed = axes.determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Vector2d a1 = products.col(0);
  // e₂ = handed·J·e₁ with J a quarter turn, so e₂·a₂ = e₁·(handed·Jᵀ·a₂).
  const Eigen::Vector2d a2 = handed * Eigen::Vector2d(products(1, 1), -products(0, 1));
  const Eigen::Matrix2d form =
      a1 * a1.transpose() / spread(0, 0) + a2 * a2.transpose() / spread(1, 1);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(form);
  Eigen::Vector2d e1 = solver.eigenvectors().col(1);
  if (e1.dot(a1) < 0.0) e1 = -e1;
  YawScales fit;
  fit.scale = {e1.dot(a1) / spread(0, 0), e1.dot(a2) / spread(1, 1)};
  if (!(fit.scale.minCoeff() > 0.0)) return std::nullopt;
  fit.yaw = wrapAngle(std::atan2(e1.y(), e1.x()) - std::atan2(axes(1, 0), axes(0, 0)));
  return fit;
}

std::optional<ScaledRotation> fitScaledRotation(std::span<const Match> matches,
                                                std::span<const double> weights,
                                                const Eigen::Matrix2d& axes) {
  const Eigen::Matrix2d a = orthonormalAxes(axes);
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  double total = 0.0;
  std::size_t used = 0;
  Eigen::Vector2d mean_q = Eigen::Vector2d::Zero();
  Eigen::Vector2d mean_p = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double w = weight(i);
    if (!(w > 0.0)) continue;
    ++used;
    total += w;
    mean_q += w * matches[i].moving;
    mean_p += w * matches[i].fixed;
  }
  if (used < 3) return std::nullopt;
  mean_q /= total;
  mean_p /= total;
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();  // columns a₁, a₂
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const double w = weight(i);
    if (!(w > 0.0)) continue;
    const Eigen::Vector2d u = a.transpose() * (matches[i].moving - mean_q);
    const Eigen::Vector2d p = matches[i].fixed - mean_p;
    products += w * p * u.transpose();
    spread += w * u * u.transpose();
  }
  // Points on one spot or one line leave a scale or the rotation open.
  const double trace = spread.trace();
  if (!(trace > 0.0) || spread.determinant() < 1e-10 * trace * trace) return std::nullopt;
  const std::optional<YawScales> best = fitYawScales(products, spread, a);
  if (!best) return std::nullopt;
  ScaledRotation fit{*best};
  fit.fixed_from_moving.linear() = fit.linear(a);
  fit.fixed_from_moving.translation() = mean_p - fit.fixed_from_moving.linear() * mean_q;
  return fit;
}

}  // namespace agricolmap
