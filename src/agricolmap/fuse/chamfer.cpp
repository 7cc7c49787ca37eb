#include "agricolmap/fuse/chamfer.hpp"

#include <algorithm>
#include <limits>

namespace agricolmap::fuse {

Raster<float> chamferDistance(const Raster<std::uint8_t>& set, double cell, float beyond) {
  constexpr float kFar = std::numeric_limits<float>::max();
  const float straight = static_cast<float>(cell), across = 1.4F * static_cast<float>(cell);
  Raster<float> distance(set.rows(), set.cols(), kFar);
  const auto at = [&](int row, int col) {
    // Half of it, so that a step can be added.
    return std::min(distance.contains(row, col) ? distance(row, col) : beyond, 0.5F * kFar);
  };
  const auto nearest = [&](int row, int col, int back) {
    if (set(row, col) != 0) return 0.0F;
    return std::min({distance(row, col), at(row, col - back) + straight,
                     at(row - back, col) + straight, at(row - back, col - back) + across,
                     at(row - back, col + back) + across});
  };
  for (int row = 0; row < set.rows(); ++row) {
    for (int col = 0; col < set.cols(); ++col) distance(row, col) = nearest(row, col, 1);
  }
  for (int row = set.rows() - 1; row >= 0; --row) {
    for (int col = set.cols() - 1; col >= 0; --col) distance(row, col) = nearest(row, col, -1);
  }
  return distance;
}

}  // namespace agricolmap::fuse
