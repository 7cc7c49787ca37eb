// The smallest rectangle around an outline.
#pragma once

#include <vector>

#include "agricolmap/report/draw/view.hpp"

namespace agricolmap::report {

/// The rectangle of least area around a hull, its first axis along the longer side and pointing
/// east. Strips lie along it whatever their direction.
GroundRect smallestRectangle(const std::vector<Eigen::Vector2d>& hull);

}  // namespace agricolmap::report
