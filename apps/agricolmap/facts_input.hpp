// What `agricolmap facts` looks at: the layers of a map's folder, or a cloud.
#pragma once

#include <filesystem>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/crop/field_layers.hpp"
#include "agricolmap/report/page/scene_colours.hpp"
#include "common.hpp"

namespace agricolmap {

struct FactsInput {
  crop::FieldLayers layers;
  report::ColourMap colours;       ///< about the layers' origin
  std::filesystem::path map_page;  ///< of a map's folder, where there is one
  Crs crs;                         ///< empty: nobody said
};

/// A folder is a map: layers/exg.tif and layers/plant_height.tif, and those of fine/ where there
/// are any, on their finer cells. Anything else is a cloud or an orthomosaic, gridded at the
/// spacing of its points. `crs` as `--crs`. Throws InputError when a layer is missing or lies
/// elsewhere.
FactsInput readFactsInput(const std::string& path, const std::string& crs, Progress& progress);

}  // namespace agricolmap
