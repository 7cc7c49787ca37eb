// Opening rasters by GDAL, with words for what cannot be opened.
#pragma once

#include <gdal_priv.h>

#include <filesystem>
#include <string>
#include <string_view>

#include "agricolmap/io/raster/raster_file.hpp"

namespace agricolmap::io {

/// A raster of more pixels than this is not read at once.
inline constexpr double kMaxPixels = 1e9;

/// Throws InputError: `what` is wrong with the file `name`, with GDAL's last word on it.
[[noreturn]] void failRaster(const std::string& name, std::string_view what);

/// Throws InputError when the file is not there, is no raster or has no bands.
GDALDatasetUniquePtr openRaster(const std::filesystem::path& path);

RasterPlace placeOf(GDALDataset& dataset);

}  // namespace agricolmap::io
