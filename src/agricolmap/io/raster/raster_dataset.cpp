#include "agricolmap/io/raster/raster_dataset.hpp"

#include <cpl_error.h>
#include <fmt/format.h>

#include <array>
#include <mutex>
#include <system_error>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/text/foreign_file.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {

void failRaster(const std::string& name, std::string_view what) {
  const std::string reason = CPLGetLastErrorMsg();
  throw InputError(fmt::format("{}: {}{}{}", name, what, reason.empty() ? "" : ": ", reason));
}

GDALDatasetUniquePtr openRaster(const std::filesystem::path& path) {
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
  std::error_code error;
  if (!std::filesystem::exists(path, error)) {
    throw InputError(fmt::format("{}: there is no such file", path.string()));
  }
  const char* const options[] = {"NUM_THREADS=ALL_CPUS", nullptr};
  CPLErrorReset();
  GDALDatasetUniquePtr dataset(
      GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY, nullptr, options));
  if (!dataset) {
    const std::string foreign = describeForeignFile(path);
    const bool raster = looksLikeRaster(path);
    if (!raster && !foreign.empty()) {
      throw InputError(fmt::format("{}: is no raster: {}", path.string(), foreign));
    }
    if (!raster && std::filesystem::is_regular_file(path, error) &&
        formatByContent(MappedFile(path).text())) {
      throw InputError(fmt::format(
          "{}: is a cloud; what is needed here is a raster, an orthomosaic or a surface "
          "model (GeoTIFF)",
          path.string()));
    }
    failRaster(path.string(), "cannot be read as a raster");
  }
  if (dataset->GetRasterCount() == 0) {
    throw InputError(fmt::format("{}: has no bands of its own", path.string()));
  }
  return dataset;
}

RasterPlace placeOf(GDALDataset& dataset) {
  RasterPlace place;
  std::array<double, 6> g{};
  if (dataset.GetGeoTransform(g.data()) == CE_None) {
    Eigen::Affine2d world_from_pixel = Eigen::Affine2d::Identity();
    world_from_pixel.linear() << g[1], g[2], g[4], g[5];
    world_from_pixel.translation() << g[0], g[3];
    place.world_from_pixel = world_from_pixel;
  }
  if (const char* wkt = dataset.GetProjectionRef()) place.crs = wkt;
  return place;
}

}  // namespace agricolmap::io
