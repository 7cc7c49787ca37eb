// A map as people name it: the file of a cloud, an orthomosaic, or an orthomosaic and its surface
// model with a comma between.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/raster_import.hpp"

namespace agricolmap::io {

struct MapFiles {
  std::filesystem::path main;  ///< of the cloud, or the orthomosaic
  std::optional<std::filesystem::path> model;
  bool raster = false;
};

/// A file of that name counts first; then the comma between two names of files. Throws InputError
/// when one of such two is not there. Whether `main` is there is found on reading.
MapFiles mapFilesOf(const std::string& text);

/// As crsOf, of rasters by what they say. Heights of rasters are metres, whatever their unit.
FileCrs crsOfMap(const MapFiles& files, const std::string& given = "");

/// A cloud, or the points of a raster: importOrtho with the coordinates as they are.
Cloud readMap(const MapFiles& files, const ReadOptions& read = {},
              const ImportOptions& options = {});

/// As streamCloud; the points of a raster are kept.
std::unique_ptr<PointStream> streamMap(const MapFiles& files, const StreamOptions& options);

}  // namespace agricolmap::io
