// What both maps see of the ground and of what stands on it, cell by cell.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::refine {

/// Cells [row0, row1) × [col0, col1) of a map.
struct Part {
  int row0, row1, col0, col1;
};

/// Ground under each cell of a part: the 10th percentile of the seen heights in a window around it,
/// from windows on a lattice, bilinear between them.
class GroundModel {
 public:
  GroundModel(const map::GridMap& map, const Part& part, double window);
  /// NaN where no window around had enough cells.
  double at(int row, int col) const;

 private:
  float lowOf(const map::GridMap& map, int r, int c, std::vector<float>& heights) const;

  int row0_;
  int col0_;
  int step_;
  Raster<float> nodes_;
};

/// A cell that both maps see.
struct GroundCell {
  Eigen::Vector2d place;  ///< fixed frame [m], later relative to the middle
  double moving_height;   ///< [m]
  double difference;      ///< fixed − moving height [m]
  double moving_canopy;   ///< height above the moving map's ground nearby, at least 0 [m]
  double fixed_canopy;    ///< and above the fixed map's [m]
  double fixed_ground;    ///< height of the latter [m]
  float greenness;        ///< Excess Green of the moving map
  int row, col;           ///< in the moving map
};

/// Weight from which on a cell counts as ground, not as more or less of it.
inline constexpr double kSurelyGround = 0.6;

/// The cell of the fixed map that lies at a place of its frame; nothing where it is empty.
bool fixedCellAt(const map::GridMap& fixed, const Eigen::Vector2d& place, int& row, int& col);

/// Every second row's every second cell of the moving map that the fixed one sees, too.
std::vector<GroundCell> groundCells(const map::GridMap& fixed, const map::GridMap& moving,
                                    const GroundModel& under_moving, const Eigen::Affine2d& pose,
                                    double window);

}  // namespace agricolmap::refine
