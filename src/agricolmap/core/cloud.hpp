// What the library needs to know about clouds beside what its callers do.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "agricolmap/cloud.hpp"

namespace agricolmap {

/// Axis-aligned box of local coordinates; empty when `min > max`.
struct Box3 {
  Eigen::Vector3f min = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
  Eigen::Vector3f max = Eigen::Vector3f::Constant(std::numeric_limits<float>::lowest());
  Eigen::Vector3f extent() const { return max - min; }
  Eigen::Vector3f centre() const { return 0.5F * (min + max); }
};

/// Bounding box of the local coordinates.
Box3 boundingBox(const Cloud& cloud);

}  // namespace agricolmap
