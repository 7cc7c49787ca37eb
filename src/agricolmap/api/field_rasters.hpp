// Public maps of a field as the rooms know them.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/raster.hpp"
#include "agricolmap/crop/facts.hpp"
#include "agricolmap/field.hpp"

namespace agricolmap {

/// Where the map's cells lie: corner in file coordinates less `origin`. Throws UsageError when it
/// has none.
GridFrame frameOf(const FieldMap& map, const Eigen::Vector2d& origin);

/// (column, row, height above the origin's) → file coordinates [m].
Transform fileFromCell(const GridFrame& frame, const Eigen::Vector3d& origin);

/// Whole metres south-west of a map.
Eigen::Vector2d originOf(const FieldMap& map);

/// The plots about an origin. Throws UsageError for one that is no polygon.
std::vector<crop::Plot> plotsAbout(const Eigen::Vector2d& origin, const std::vector<Plot>& plots);

/// A layer of `rows` × `cols`. Throws UsageError when it has another number of values.
template <typename Value>
Raster<Value> rasterOf(int rows, int cols, const std::vector<Value>& values,
                       const std::string& layer) {
  Raster<Value> raster(rows, cols);
  if (values.size() != raster.size()) {
    throw UsageError(fmt::format("the layer {} has {} values for {} x {} cells", layer,
                                 values.size(), rows, cols));
  }
  std::copy(values.begin(), values.end(), raster.begin());
  return raster;
}

template <typename Value>
std::vector<Value> valuesOf(const Raster<Value>& raster) {
  return {raster.begin(), raster.end()};
}

}  // namespace agricolmap
