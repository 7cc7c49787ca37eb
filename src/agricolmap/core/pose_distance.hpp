// How far apart two poses are, in metres: a heading and a scale matter as much as they move points.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace agricolmap {

/// Largest distance between where two maps put some points, say the corners of a strip. Over a
/// convex area no point is farther apart than one of its corners, both maps being affine.
template <typename Points>
double poseDistance(const Points& points, const Eigen::Affine2d& a, const Eigen::Affine2d& b) {
  double largest = 0.0;
  for (const Eigen::Vector2d& point : points) {
    largest = std::max(largest, (a * point - b * point).norm());
  }
  return largest;
}

/// Low left, low right, high left, high right.
inline std::array<Eigen::Vector2d, 4> cornersOf(const Eigen::AlignedBox2d& box) {
  const Eigen::Vector2d &low = box.min(), &high = box.max();
  return {low, {high.x(), low.y()}, {low.x(), high.y()}, high};
}

}  // namespace agricolmap
