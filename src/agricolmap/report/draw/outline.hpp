// The outline of a set of points, and the smallest rectangle around it.
#pragma once

#include <vector>

#include "agricolmap/report/draw/view.hpp"

namespace agricolmap::report {

/// Corners of the convex hull, anticlockwise (Andrew's monotone chain). Fewer than three points
/// come back as they are.
std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points);

/// The rectangle of least area around a hull, its first axis along the longer side and pointing
/// east. Strips lie along it whatever their direction.
GroundRect smallestRectangle(const std::vector<Eigen::Vector2d>& hull);

}  // namespace agricolmap::report
