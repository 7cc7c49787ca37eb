// Rotation, two scales and a shift between matched points, in closed form.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <span>

#include "agricolmap/core/placement.hpp"

namespace agricolmap {

/// p ≈ R(yaw)·A·diag(scale)·Aᵀ·q + shift for matches (q moving, p fixed) and the axes A.
struct ScaledRotation {
  double yaw = 0.0;                                 ///< [rad]
  Eigen::Vector2d scale = Eigen::Vector2d::Ones();  ///< along the first and second axis
  Eigen::Affine2d fixed_from_moving = Eigen::Affine2d::Identity();
};

/// The orthonormal axes nearest to `axes` (levelling may leave the file's axes not quite so).
Eigen::Matrix2d orthonormalAxes(const Eigen::Matrix2d& axes);

/// Minimises Eq. 3 of the paper, Σ w·|p − R·S·q − t|², over a rotation, a scale along each of two
/// axes, and a shift.
///
/// With centred p and u = Aᵀq, and e₁, e₂ = J·e₁ the unit vectors that R turns the axes to, the
/// cost is Σ w(e₁·p − s₁u₁)² + w(e₂·p − s₂u₂)². Its minimum over the scales is s_k = e_k·a_k / q_k
/// with a_k = Σ w·u_k·p and q_k = Σ w·u_k², and what is left to maximise is (e₁·a₁)²/q₁ +
/// (e₂·a₂)²/q₂ = e₁ᵀ(a₁a₁ᵀ/q₁ + Jᵀa₂a₂ᵀJ/q₂)e₁, a quadratic form: e₁ is the eigenvector of its
/// largest eigenvalue, with the sign that makes s₁ positive.
///
/// `weights` is empty (all 1) or one per match. Nothing when fewer than 3 matches have weight, when
/// the points span no area, or when the best map mirrors.
std::optional<ScaledRotation> fitScaledRotation(std::span<const Match> matches,
                                                std::span<const double> weights,
                                                const Eigen::Matrix2d& axes);

}  // namespace agricolmap
