// A grid map as it looks after a linear map of its ground plane.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::map {

/// `map` moved by `warped_from_map` (levelled frame [m]), resampled with the same cell size: means
/// of the up to four cells that hold points around each new centre, which is empty where fewer than
/// half of the bilinear weight falls on such cells. `colour` is that of the cell the centre falls
/// into or of the best known of the four.
GridMap warped(const GridMap& map, const Eigen::Affine2d& warped_from_map);

}  // namespace agricolmap::map
