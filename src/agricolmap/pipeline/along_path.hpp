// Placing a strip along the robot's path.
#pragma once

#include <vector>

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// By pieces where the strip is long and its path is known, else as a whole. `places`: of the
/// robot, in the moving file's coordinates; none: the strip's shape tells its path. `maps.fixed`
/// becomes what of it a long strip can reach.
Outcome placeAlongPath(const Cloud& moving, const std::vector<Eigen::Vector3d>& places,
                       const RegistrationOptions& options, const Locator& locator, Monitor& monitor,
                       PairMaps& maps);

}  // namespace agricolmap::pipeline
