// The outline of a set of points.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace agricolmap {

/// Corners of the convex hull, anticlockwise (Andrew's monotone chain). Fewer than three points
/// come back as they are.
std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points);

}  // namespace agricolmap
