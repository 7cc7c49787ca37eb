// Slices across the strip, each correlated with the fixed map alone: their scores add up to those
// of any part of the strip, so that all parts are looked at for the price of one.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/correlation/strip_score.hpp"

namespace agricolmap::verdict {

/// A slice of the strip, from `begin` to `end` along it, counted from the low end of its frame [m].
struct Slice {
  double begin = 0.0;
  double end = 0.0;
  /// By shift from where the pose puts the slice, in whole cells of the fixed map; the middle
  /// element is no shift.
  Raster<float> scores;
  /// Of the scores of far shifts, which is what chance gives; 0 where too little of the slice is
  /// seen in either map, or too little around it.
  double deviation = 0.0;

  bool tells() const { return deviation > 0.0; }
};

struct Slices {
  double cell = 0.0;  ///< of a shift [m]
  int reach = 0;      ///< largest shift along an axis [cells]
  std::vector<Slice> slices;
};

/// At least six slices of at least 0.4 m (fewer of a shorter strip), about 0.8 m each, at most 50.
/// Shifts reach as far as `reach` [m] or 40 cells, whichever is less.
Slices scoreSlices(const correlation::StripScore& score, const Eigen::Affine2d& pose, double reach);

}  // namespace agricolmap::verdict
