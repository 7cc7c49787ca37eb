// Where each slice of a strip lies, all slices taken together: most lie where the pose puts them,
// drift moves neighbours by little, and a slip moves all behind it at once.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/verdict/slices.hpp"

namespace agricolmap::verdict {

struct SlicePath {
  std::vector<Eigen::Vector2i> shifts;  ///< of each slice, x and y [cells]
  /// Logarithm of how much likelier each slice's score makes that shift than none.
  std::vector<double> gain;
  /// Of the whole path against none, what such a path is likely by itself included; not below 0.
  double log_odds = 0.0;
};

/// The likeliest path of shifts of up to `reach` [m]. Empty when no slice tells anything, or all
/// tell of nothing in common.
SlicePath likeliestPath(const Slices& slices, double reach);

}  // namespace agricolmap::verdict
