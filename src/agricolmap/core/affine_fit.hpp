// The affine closest to known positions.
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "agricolmap/core/cloud.hpp"

namespace agricolmap {

/// Mean of the cloud's local coordinates [m]; zero for an empty cloud.
Eigen::Vector3d meanPoint(const Cloud& cloud);

/// The affine from the cloud's file coordinates to `targets` (one a point, any size of coordinates)
/// with the least sum of squares. In a flat cloud what is across the plane is left open; the points
/// themselves are mapped well all the same. Throws InputError when there are fewer than four points
/// or the numbers differ.
Eigen::Affine3d fitAffine(const Cloud& cloud, const std::vector<Eigen::Vector3d>& targets);

/// The same for some hand-picked points with weights (>= 0, one each), in double throughout. Both
/// sides should be near zero; the caller sees to it that the points with weight span a volume.
Eigen::Affine3d fitAffine(std::span<const Eigen::Vector3d> from,
                          std::span<const Eigen::Vector3d> targets,
                          std::span<const double> weights);

}  // namespace agricolmap
