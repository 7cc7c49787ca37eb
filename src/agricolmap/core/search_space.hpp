// How wrong the initial guess may be, and with it where the moving map is looked for.
#pragma once

#include <Eigen/Core>

#include "agricolmap/core/options.hpp"

namespace agricolmap {

/// A translation error of this size [m] means: anywhere in the fixed map.
inline constexpr double kAnywhere = 1e6;

/// How wrong the initial guess may be (defaults: the paper's, Sec. V-A). Limits, not deviations.
struct PriorUncertainty {
  /// No guess at all: any position and heading; scales within the default.
  static PriorUncertainty none();
  bool anywhere() const { return translation >= kAnywhere; }

  double translation = 5.0;    ///< horizontal, at the moving map's centre [m]
  double heading_deg = 11.5;   ///< [°]
  double scale = 0.30;         ///< of each horizontal axis, relative (0.30: 0.7–1.3)
  bool scale_unknown = false;  ///< and of all three axes together, by a factor from 0.1 to 10
};
void listOptions(OptionTable& table, PriorUncertainty& options);

/// Half-width of the interval of log-scales: a file whose axis is off by a factor of 1 ± scale
/// needs a correction between 1/(1 + scale) and 1/(1 − scale); ±log 1/(1 − scale) covers both
/// readings.
double logScaleLimit(const PriorUncertainty& uncertainty);

/// What an association knows beside the two maps. The moving map is gridded with the initial guess
/// applied: where the guess is right, the flow is zero.
struct SearchSpace {
  PriorUncertainty uncertainty;
  /// Directions of the moving file's x and y axes in the levelled frame (columns, unit length):
  /// directional scale errors act along them.
  Eigen::Matrix2d scale_axes = Eigen::Matrix2d::Identity();
  /// Point of the moving map that `translation` is about [m].
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  /// By how much the levelled frames are turned against the fixed file's axes, counter-clockwise
  /// [rad].
  double turn = 0.0;
  /// What is done to the moving map before it is turned and scaled: a reflection makes a decoy of
  /// it, which lies nowhere in the fixed map.
  Eigen::Matrix2d mirror = Eigen::Matrix2d::Identity();
};

}  // namespace agricolmap
