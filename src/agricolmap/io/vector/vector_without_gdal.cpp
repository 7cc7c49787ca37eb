// Stands for vector_file.cpp where GDAL is not built in.
#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw UsageError(fmt::format(
      "{}: GeoPackages need GDAL, and this build has none (AGRICOLMAP_WITH_GDAL)", name));
}

}  // namespace

void writeGeoPackage(const OutputPath& path, const std::vector<VectorLayer>& /*layers*/,
                     const Crs& /*crs*/) {
  refuse(path.shown());
}

std::optional<std::vector<Eigen::Vector2d>> geographic(
    const Crs& /*crs*/, const std::vector<Eigen::Vector2d>& /*points*/) {
  return std::nullopt;
}

std::vector<NamedPolygon> readPolygons(const std::filesystem::path& path, const Crs& /*crs*/) {
  refuse(path.string());
}

}  // namespace agricolmap::io
