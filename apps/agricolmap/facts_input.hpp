// What `agricolmap facts` looks at: the layers of a map's folder, or a cloud.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"
#include "common.hpp"

namespace agricolmap {

struct FactsInput {
  GridFrame frame;                                   ///< file coordinates less `origin` [m]
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< whole metres
  Crs crs;                                           ///< empty: nobody said
  Raster<float> exg;                                 ///< chromatic, NaN where there is none
  Raster<float> height;                              ///< above ground, or above the field's plane
  bool above_ground = false;                         ///< which of them `height` is
};

/// A folder is a map: layers/exg.tif and layers/plant_height.tif, and those of fine/ where there
/// are any, on their finer cells. Anything else is a cloud or an orthomosaic, gridded at the
/// spacing of its points. `crs` as `--crs`. Throws InputError when a layer is missing or lies
/// elsewhere.
FactsInput readFactsInput(const std::string& path, const std::string& crs, Progress& progress);

}  // namespace agricolmap
