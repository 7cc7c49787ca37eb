// All rows of a field and what stands in them.
#pragma once

#include <vector>

#include "agricolmap/crop/plants.hpp"
#include "agricolmap/crop/row_lattice.hpp"

namespace agricolmap::crop {

struct FieldRow {
  RowLine line;
  RowProfile profile;
  RowPlants stand;
};

struct FieldRows {
  double row_spacing = 0.0;  ///< [m]; 0: no rows
  double heading = 0.0;      ///< of the rows, counter-clockwise from x [rad]
  double half_width = 0.0;   ///< of what is looked at as a row [m]
  double plant_half = 0.0;   ///< and of what plants are looked for in [m]
  PlantSpacing spacing;      ///< of plants; distance 0: plants cannot be counted
  double model_error = 0.0;  ///< deviation of plants' number, as a share; see modelError
  std::vector<FieldRow> rows;
};

/// Rows of the greenness, and their plants where these stand apart.
FieldRows findRows(const GridFrame& frame, const Raster<float>& green, const RowOptions& options);

}  // namespace agricolmap::crop
