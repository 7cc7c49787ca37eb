// Stands for raster_file.cpp and raster_place.cpp where GDAL is not built in.
#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/io/raster/raster_place.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw UsageError(fmt::format(
      "{}: reading rasters needs GDAL, and this build has none (AGRICOLMAP_WITH_GDAL)", name));
}

}  // namespace

void silenceGdal() {}

RasterShape readRasterShape(const std::filesystem::path& path) { refuse(path.string()); }

RasterImage readRaster(const std::filesystem::path& path, const RasterOptions& /*options*/,
                       const RasterPart& /*part*/) {
  refuse(path.string());
}

RasterHeights readHeights(const std::filesystem::path& path, const RasterPart& /*part*/) {
  refuse(path.string());
}

void checkGeoreference(const std::string& name, const RasterPlace& /*place*/) { refuse(name); }

void checkMetres(const std::string& name, const RasterPlace& /*place*/) { refuse(name); }

std::optional<std::string> checkSameCrs(const std::string& name, const RasterPlace& /*place*/,
                                        const std::string& /*other_name*/,
                                        const RasterPlace& /*other_place*/) {
  refuse(name);
}

}  // namespace agricolmap::io
