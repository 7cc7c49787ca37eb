// The lattices of heading and scales that the correlation search tries.
#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <vector>

#include "agricolmap/core/scaled_rotation.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/map/blocks.hpp"

namespace agricolmap::locate {

/// A heading error and two scale factors, relative to the initial guess.
using Hypothesis = YawScales;

/// Mean squared displacement of the points of a rectangle about its middle, as a quadratic form in
/// a small change of (yaw, log s_x, log s_y) [m²]. `axes`, `half_extent`: of the rectangle.
Eigen::Matrix3d displacementMetric(const Eigen::Matrix2d& axes, const Eigen::Vector2d& half_extent,
                                   const Eigen::Matrix2d& scale_axes);

/// Hypotheses within the uncertainty's limits, the initial guess itself among them, such that any
/// other is within an RMS displacement of about `radius` [m] of one under `metric`. A body-centred
/// cubic lattice in the metric's own coordinates: the thinnest covering there is in three
/// dimensions, and it does not grow when the strip lies obliquely to the scale axes.
std::vector<Hypothesis> coverSpace(const PriorUncertainty& uncertainty,
                                   const Eigen::Matrix3d& metric, double radius);

/// Finds which of some hypotheses moves the points of a rectangle most nearly as another does.
class NearestHypothesis {
 public:
  /// `metric`: displacementMetric of the rectangle. `among` must not be empty.
  NearestHypothesis(const std::vector<Hypothesis>& among, const Eigen::Matrix3d& metric);
  /// Index of the nearest; of several, the first.
  std::size_t of(const Hypothesis& hypothesis) const;

 private:
  using Bin = std::array<int, 3>;
  Bin binOf(const Eigen::Vector3d& unit) const;

  Eigen::Matrix3d unit_from_parameters_;  ///< where the metric is the unit matrix
  std::vector<Eigen::Vector3d> points_;   ///< there [m]
  double side_ = 1.0;                     ///< of a bin [m]
  std::map<Bin, std::vector<std::size_t>> bins_;
};

}  // namespace agricolmap::locate
