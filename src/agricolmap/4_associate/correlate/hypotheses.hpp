// The lattices of heading and scales that the correlation search tries.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/4_associate/association.hpp"

namespace agricolmap {

/// A heading error and two scale factors, relative to the initial guess.
struct Hypothesis {
  double yaw = 0.0;  ///< [rad]
  double scale_x = 1.0;
  double scale_y = 1.0;
};

/// Linear map R(yaw) · A · diag(s_x, s_y) · Aᵀ with A the directions of the scales.
Eigen::Matrix2d linearOf(const Hypothesis& hypothesis, const Eigen::Matrix2d& scale_axes);

/// Evenly spaced values that cover [−limit, limit] with no point further than step/2 from one.
std::vector<double> coverInterval(double limit, double step);

/// All combinations such that a point `half_extent` from the centre (per scale axis; their norm for
/// the heading) is nowhere off by more than `tolerance` per parameter [m].
std::vector<Hypothesis> coverSpace(const PriorUncertainty& uncertainty,
                                   const Eigen::Vector2d& half_extent, double tolerance);

}  // namespace agricolmap
