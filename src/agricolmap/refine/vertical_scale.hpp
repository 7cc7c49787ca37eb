// Stage heights: whether a metre up is a metre in both maps. A map from one moving camera has a
// vertical scale as it has horizontal ones; where the ground itself rises and falls by more than
// the maps err, it tells.
#pragma once

#include <limits>
#include <vector>

#include "agricolmap/refine/ground_cells.hpp"

namespace agricolmap::refine {

/// Metres up in the fixed map for one in the moving map.
struct VerticalScale {
  double value = 1.0;
  double deviation = std::numeric_limits<double>::infinity();  ///< infinite: nothing tells it
  double relief = 0.0;       ///< of the moving map's ground beyond a plane, deviation [m]
  double correlation = 0.0;  ///< of the two maps' reliefs

  /// Whether the ground tells it well enough to be stated.
  bool measured() const { return deviation <= kMostDeviation; }
  /// Whether it is another one than 1 for sure.
  bool clear() const;

  static constexpr double kMostDeviation = 0.05;
};

/// From the relief of the ground, beyond an inclined plane, in patches of `patch` metres: the ratio
/// of the two maps' deviations (reduced major axis, as both err). What parts the reliefs, and how
/// the ratio changes when stretches of the strip are left out, is its deviation. Plants do not
/// count: that they grew, and that a drone sees canopies lower than they
/// are, looks like another scale. `ground`: weight of each cell as ground in both maps; `lift`:
/// what blurred plants lift the fixed map by there [m].
VerticalScale measureVerticalScale(const std::vector<GroundCell>& cells,
                                   const std::vector<double>& ground,
                                   const std::vector<double>& lift, double patch);

}  // namespace agricolmap::refine
