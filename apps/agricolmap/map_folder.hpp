// A shared map as it lies on the disk: map.json and its layers.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace agricolmap {

struct MapFolder {
  std::filesystem::path folder;
  nlohmann::json description;  ///< map.json

  /// layers/NAME.tif; nothing where the map has no such layer.
  std::optional<std::filesystem::path> layer(const std::string& name) const;
  /// Whether both hang on one drone's map: of one name, date and number of points.
  bool hasFixedOf(const MapFolder& other) const;
};

/// Throws InputError when the folder has no map.json, or one that is damaged, of another kind or
/// newer than this program.
MapFolder openMapFolder(const std::filesystem::path& folder);

}  // namespace agricolmap
