// Clouds as maps of cells: what a registration compares, to be looked at and computed with.
#pragma once

#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"
#include "agricolmap/options.hpp"
#include "agricolmap/register.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

/// A cloud seen along its ground's normal, in square cells. Values are row-major; row 0 is the
/// southernmost where the map lies as its file does. Where no point fell, values are NaN, colours
/// black and the weight 0.
struct CellMap {
  int rows = 0;
  int cols = 0;
  double cell_m = 0.0;  ///< side of a cell
  /// (column, row, height above the ground [m]) → file coordinates [m]. Corners of cells are whole
  /// numbers: the middle of the first one is (0.5, 0.5).
  Transform file_from_cell = Transform::Identity();
  std::vector<float> height_m;      ///< mean, above the ground plane
  std::vector<float> excess_green;  ///< mean; all NaN for a cloud without colours
  std::vector<float> weight;        ///< points that a cell's values rest on
  std::vector<Rgb> colour;          ///< mean
};

/// Both maps of a registration.
struct ComparedMaps {
  CellMap fixed;
  /// In the fixed file's coordinates, too, where the transformation lays it, and without one where
  /// the guess does; bends are not taken out. Without cells where no guess of its scale held.
  CellMap moving;
};

/// Of what registerClouds returned; else throws UsageError.
AGRICOLMAP_EXPORT ComparedMaps comparedMaps(const Registration& registration);

/// The stages level and grid alone: the whole of a cloud as a map, in its own file's coordinates.
/// Of the options those of `level` and `grid` count. Throws InputError for clouds that cannot be
/// used, UsageError, Interrupted.
AGRICOLMAP_EXPORT CellMap mapCloud(const Cloud& cloud, const Options& options = Options(),
                                   const Control& control = {});

}  // namespace agricolmap
