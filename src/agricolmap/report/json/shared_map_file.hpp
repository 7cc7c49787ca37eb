// map.json: what a shared map is made of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/fuse/shared_map.hpp"

namespace agricolmap::report {

/// One cloud of a shared map, as its files know it.
struct MapSource {
  std::string id;
  std::string file;    ///< of a strip: within the map's folder; of the fixed cloud: as it was named
  std::string run;     ///< the folder of its registration
  std::string status;  ///< of it
  bool heights_limited = false;  ///< of it
  std::uint64_t points = 0;      ///< in its file
  std::uint64_t kept = 0;        ///< of these in the fused cloud
  std::int32_t date = 0;         ///< YYYYMMDD; 0: nobody said
  fuse::StripErrors errors;      ///< of a strip
};

/// What only those know who read and write the files.
struct MapFacts {
  Crs crs;
  MapSource fixed;
  std::vector<MapSource> strips;    ///< in the order of SharedMap::strips
  std::string cloud;                ///< the fused one, within the folder; empty: none
  std::vector<std::string> layers;  ///< files within the folder
  std::vector<std::string> command_line;
  std::string version;
};

/// The text of map.json.
std::string sharedMapJson(const fuse::SharedMap& map, const MapFacts& facts,
                          const fuse::FuseOptions& options);

/// What a strip has in a shared map.
struct StripShare {
  std::uint16_t code = fuse::kNoSource;             ///< in the layer `source`
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();  ///< by the adjustment [m]
  double seen_area = 0.0;                           ///< [m²]
  double owned_area = 0.0;                          ///< [m²]
};

/// A shared map as it lies on the disk.
struct StoredMap {
  std::filesystem::path folder;
  Crs crs;
  bool flat = false;  ///< its clouds have no heights, and it no layers of them
  MapSource fixed;
  std::vector<MapSource> strips;
  std::vector<StripShare> shares;  ///< as `strips`
  std::vector<std::string> warnings;

  /// layers/NAME.tif; nothing where the map has no such layer.
  std::optional<std::filesystem::path> layer(const std::string& name) const;
  /// Whether both hang on one fixed cloud: of one name, date and number of points.
  bool hasFixedOf(const StoredMap& other) const;
};

/// Whether a folder holds a shared map.
bool isSharedMap(const std::filesystem::path& folder);

/// Throws InputError that names the file when it is missing, damaged, of another kind or version.
StoredMap readSharedMap(const std::filesystem::path& folder);

}  // namespace agricolmap::report
