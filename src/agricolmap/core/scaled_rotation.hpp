// Rotation, two scales and a shift: what an initial guess may be wrong by on flat ground, and the
// closed-form fit of it to matched points.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "agricolmap/core/placement.hpp"

namespace agricolmap {

/// A heading and a scale along each of two orthonormal axes A (columns).
struct YawScales {
  double yaw = 0.0;                                 ///< [rad]
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();  ///< along the first and second axis

  /// R(yaw)·A·diag(scale)·Aᵀ.
  Eigen::Matrix2d linear(const Eigen::Matrix2d& axes) const;
  /// (yaw, log scale): small changes of these move points linearly.
  Eigen::Vector3d vector() const;
  static YawScales fromVector(const Eigen::Vector3d& vector);
};

/// p ≈ R(yaw)·A·diag(scale)·Aᵀ·q + shift for matches (q moving, p fixed) and the axes A.
struct ScaledRotation : YawScales {
  Eigen::Affine2d fixed_from_moving = Eigen::Affine2d::Identity();
};

/// The orthonormal axes nearest to `axes` (levelling may leave the file's axes not quite so).
Eigen::Matrix2d orthonormalAxes(const Eigen::Matrix2d& axes);

/// Minimises Eq. 3 of the paper, Σ w·|p − R·S·q|², over a rotation and a scale along each of two
/// axes, for points about their weighted means. Needs only their moments: with u = Aᵀq,
/// `products` = Σ w·p·uᵀ and `spread` = Σ w·u·uᵀ.
///
/// With e₁ and e₂ = J·e₁ the unit vectors that R turns the axes to, the cost is Σ w(e₁·p − s₁u₁)² +
/// w(e₂·p − s₂u₂)². Its minimum over the scales is s_k = e_k·a_k / q_k with a_k = Σ w·u_k·p and
/// q_k = Σ w·u_k², and what is left to maximise is (e₁·a₁)²/q₁ + (e₂·a₂)²/q₂ =
/// e₁ᵀ(a₁a₁ᵀ/q₁ + Jᵀa₂a₂ᵀJ/q₂)e₁, a quadratic form: e₁ is the eigenvector of its largest
/// eigenvalue, with the sign that makes s₁ positive.
///
/// Nothing when the best map mirrors.
std::optional<YawScales> fitYawScales(const Eigen::Matrix2d& products,
                                      const Eigen::Matrix2d& spread, const Eigen::Matrix2d& axes);

/// The same for matches, with the shift: Σ w·|p − R·S·q − t|². `weights` is empty (all 1) or one
/// per match. Nothing when fewer than 3 matches have weight, when the points span no area, or when
/// the best map mirrors.
std::optional<ScaledRotation> fitScaledRotation(std::span<const Match> matches,
                                                std::span<const double> weights,
                                                const Eigen::Matrix2d& axes);

}  // namespace agricolmap
