// By how much the fixed cloud's heights are wrong over plants, measured where strips lie, and what
// of it is undone elsewhere.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/fuse/strip_cells.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::fuse {

/// Strip minus fixed cloud, of cells of one kind, by how high the fixed cloud lies above the ground
/// there: means in classes, with lines between their middles.
struct HeightCurve {
  std::vector<double> height;     ///< middle of a class [m]
  std::vector<double> shift;      ///< mean of strip − fixed cloud [m]
  std::vector<double> deviation;  ///< of a cell about it [m]

  bool empty() const { return height.empty(); }
  double shiftAt(double height_above_ground) const;
  double deviationAt(double height_above_ground) const;
};

/// A cell's kind and height: what the bias goes by.
struct FixedHeights {
  const map::GridMap& map;
  const Raster<float>& ground;  ///< NaN where none is seen
  const Raster<float>& cover;   ///< of the fixed cloud itself
};

struct HeightShift {
  double mean = 0.0;       ///< [m]
  double deviation = 0.0;  ///< [m]
};

/// What strips show of the fixed cloud's heights.
struct HeightBias {
  /// Of soil (less than half covered), of plants, and of plants where no ground is seen: there
  /// height says nothing, and one mean stands for all.
  std::array<HeightCurve, 3> curves;
  /// Deviation of what is left in the mean of a strip: how far the curves hold from place to place
  /// [m]. NaN with fewer than two strips.
  double between_strips = 0.0;
  std::size_t cells = 0;

  /// Mean and deviation of strip − fixed cloud in cell `i`; nothing where nobody knows.
  std::optional<HeightShift> at(const FixedHeights& fixed, std::size_t i) const;
};

/// By the cells well inside what the strips saw. Nothing where they show too few.
std::optional<HeightBias> heightBiasOf(const FixedHeights& fixed,
                                       const std::vector<const StripCells*>& strips);

}  // namespace agricolmap::fuse
