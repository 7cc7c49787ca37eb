// Statistics that a few wild values do not move: ranks, deviations from medians, Tukey's biweight.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "agricolmap/core/error.hpp"

namespace agricolmap {

/// The value that would stand at `rank` (0: the least) if `values` were sorted; it reorders them.
///
/// For all ranks below: values have no order when there is a NaN among them, so callers leave NaN
/// out. Throws UsageError when there is no such rank, as in an empty list.
template <typename Values>
auto valueAtRank(Values&& values, std::size_t rank) {
  if (rank >= std::size(values)) throw UsageError("there is no such rank in a list of values");
  const auto place = std::begin(values) + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(std::begin(values), place, std::end(values));
  return *place;
}

/// The value at rank ⌊share · n⌋, the largest for a share of 1: at least `share` of the values are
/// not above it. No interpolation: it is one of them.
template <typename Values>
auto quantile(Values&& values, double share) {
  const std::size_t count = std::size(values);
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(count));
  return valueAtRank(std::forward<Values>(values), std::min(rank, count > 0 ? count - 1 : 0));
}

/// The middle value, of an even number of values the larger one of the two in the middle.
template <typename Values>
auto median(Values&& values) {
  return valueAtRank(std::forward<Values>(values), std::size(values) / 2);
}

/// Median distance from its mean of what is normal on a line, and in a plane (Rayleigh), in
/// deviations of a coordinate.
inline constexpr double kMedianOnLine = 0.6745;
inline constexpr double kMedianInPlane = 1.1774;
/// Deviation of what is normal in medians of the distance: 1 / 0.6745.
inline constexpr double kMadToDeviation = 1.4826;

/// Robust deviation from `distances` (absolute residuals of a coordinate); it reorders them.
template <typename Values>
double deviationFrom(Values&& distances) {
  return kMadToDeviation * median(std::forward<Values>(distances));
}

/// Tukey's biweight of a residual `u` in units of where the weight reaches 0: (1 − u²)² within.
inline double tukeyWeight(double u) {
  return std::abs(u) < 1.0 ? (1.0 - u * u) * (1.0 - u * u) : 0.0;
}

}  // namespace agricolmap
