// A strip on the lattice of the shared map: what it shows of each cell, and how much of it it saw.
#pragma once

#include <Eigen/Core>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::fuse {

/// The map's cells, and those of strips: each of the former is `factor` × `factor` of the latter.
struct Lattice {
  GridFrame frame;  ///< of the whole map
  int factor = 1;
};

struct StripCells {
  int row = 0;  ///< of the map's frame, where the window begins
  int col = 0;
  map::GridMap coarse;  ///< means over the strips' cells in it
  /// How far from what the strip did not see the middle of a cell of the map lies [m]; 0: not seen.
  Raster<float> depth;

  bool seen(int map_row, int map_col) const {
    return depth.contains(map_row - row, map_col - col) && depth(map_row - row, map_col - col) > 0;
  }
};

/// The window is what of the cloud's bounds lies in the map. `shift`: local coordinates of the
/// cloud → those of the map. A cell counts as seen where it holds at least `least_seen` of the
/// median number of points, and single cells follow those around them: what a plant hides stays
/// unseen, noise at the border is dropped.
StripCells stripCells(const PointStream& cloud, const Eigen::Vector3d& shift,
                      const Lattice& lattice, double least_seen);

/// The same window in the strips' cells: made when it is asked for, as of a hundred strips it would
/// fill the memory.
map::GridMap fineCells(const PointStream& cloud, const Eigen::Vector3d& shift,
                       const Lattice& lattice);

}  // namespace agricolmap::fuse
