// Holes that nobody declared: points or pixels that exporters give one height far below all others
// (-9999, or 0 where the field is at 300 m).
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace agricolmap::io {

/// The two lowest heights of many.
struct LowestHeights {
  double lowest = std::numeric_limits<double>::infinity();
  double next = std::numeric_limits<double>::infinity();

  void take(double height);
  LowestHeights& operator+=(const LowestHeights& other);
};

/// The lowest height, where it is that of holes: by more than 30 m, and more than three times what
/// the others spread over, below them. `samples` [m] are some of all heights, holes included.
std::optional<double> holeHeight(const LowestHeights& heights, std::vector<double> samples);

}  // namespace agricolmap::io
