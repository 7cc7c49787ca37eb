// A refinement lays a strip that slipped by the affine that fits both parts best, and neither well.
// The slip and the affine are told apart here.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

namespace agricolmap::verdict {

/// How far a slice of the strip lies beside where a pose puts it.
struct SliceOffset {
  double along = 0.0;                                ///< its middle, from the strip's middle [m]
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< [m]
};

/// The displacement that undoes an affine's compromise for the larger part of a strip with one
/// slip: shift + slope · along [m] for a point `along` [m] the strip from its middle.
struct Compromise {
  Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
};

/// From the offsets of slices in order along the strip. Nothing where no slip explains most of what
/// they differ by.
std::optional<Compromise> largerPart(const std::vector<SliceOffset>& slices);

}  // namespace agricolmap::verdict
