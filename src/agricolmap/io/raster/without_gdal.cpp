// Stands for what reads, places and writes rasters where GDAL is not built in.
#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/geo_writer.hpp"
#include "agricolmap/io/raster/mosaic_writer.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "agricolmap/io/raster/raster_place.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw UsageError(fmt::format(
      "{}: rasters need GDAL, and this build has none; build it with -DAGRICOLMAP_WITH_GDAL=ON",
      name));
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

bool sameHorizontally(const std::string& name, const std::string& /*wkt*/,
                      const std::string& /*other_name*/, const std::string& /*other_wkt*/) {
  refuse(name);
}

std::optional<std::string> checkSameCrs(const std::string& name, const RasterPlace& /*place*/,
                                        const std::string& /*other_name*/,
                                        const RasterPlace& /*other_place*/) {
  refuse(name);
}

LayerShape readLayerShape(const std::filesystem::path& path) { refuse(path.string()); }

template <typename T>
Layer<T> readLayer(const std::filesystem::path& path, const std::optional<CellWindow>& /*window*/) {
  refuse(path.string());
}

template Layer<float> readLayer(const std::filesystem::path&, const std::optional<CellWindow>&);
template Layer<std::uint8_t> readLayer(const std::filesystem::path&,
                                       const std::optional<CellWindow>&);
template Layer<std::uint16_t> readLayer(const std::filesystem::path&,
                                        const std::optional<CellWindow>&);
template Layer<std::int32_t> readLayer(const std::filesystem::path&,
                                       const std::optional<CellWindow>&);
template Layer<Rgb> readLayer(const std::filesystem::path&, const std::optional<CellWindow>&);

void writeLayer(const OutputPath& path, const GeoLayer& /*layer*/) { refuse(path.shown()); }

void writeMosaic(const OutputPath& path, const Mosaic& /*mosaic*/) { refuse(path.shown()); }

}  // namespace agricolmap::io
