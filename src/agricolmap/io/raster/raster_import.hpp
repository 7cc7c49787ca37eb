// A coloured height raster pair, as OpenDroneMap, Pix4D or Metashape write it, as a cloud.
#pragma once

#include <filesystem>
#include <optional>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/options.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/raster/raster_file.hpp"

namespace agricolmap::io {

struct ImportOptions {
  RasterOptions raster;
  int step = 1;               ///< keep every n-th pixel of every n-th row
  double max_height = 100.0;  ///< farthest from the median height that is believed [m]
};
void listOptions(OptionTable& table, ImportOptions& options);

/// One point per valid pixel of the orthomosaic, at the pixel's centre, in its own coordinates,
/// brought elsewhere by `map` if there is one, with the surface model's height there (bilinear; the
/// model may have another resolution, extent and rotation), or 0 without a model, which is a
/// warning. Pixels without a height, or with one farther than `max_height` from the median (nodata
/// that is not declared), are dropped and counted; those that transparency takes away are told.
///
/// Throws InputError when a file is not georeferenced, both have different coordinate systems, they
/// do not overlap, or the orthomosaic has no colours.
Cloud importOrtho(const std::filesystem::path& ortho,
                  const std::optional<std::filesystem::path>& dsm,
                  const ImportOptions& options = {}, const CoordinateMap* map = nullptr);

/// The same of rasters in projected metres; others are refused.
Cloud importOrthoDsm(const std::filesystem::path& ortho,
                     const std::optional<std::filesystem::path>& dsm,
                     const ImportOptions& options = {});

}  // namespace agricolmap::io
