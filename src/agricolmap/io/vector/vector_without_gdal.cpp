// Stands for vector_file.cpp where GDAL is not built in.
#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void refuse(const std::string& name) {
  throw UsageError(fmt::format(
      "{}: maps of polygons need GDAL, and this build has none (AGRICOLMAP_WITH_GDAL)", name));
}

}  // namespace

void writeGeoPackage(const OutputPath& path, const std::vector<VectorLayer>& /*layers*/,
                     const Crs& /*crs*/) {
  refuse(path.shown());
}

void writeShapefile(const OutputPath& dir, const VectorLayer& /*layer*/, const Crs& /*crs*/) {
  refuse(dir.shown());
}

std::optional<std::vector<Eigen::Vector2d>> geographic(
    const Crs& /*crs*/, const std::vector<Eigen::Vector2d>& /*points*/) {
  return std::nullopt;
}

std::optional<std::vector<Eigen::Vector2d>> fromGeographic(
    const Crs& /*crs*/, const std::vector<Eigen::Vector2d>& /*points*/) {
  return std::nullopt;
}

Crs geographicCrs() { return {}; }

std::vector<CodePolygon> codePolygons(const Raster<std::uint8_t>& /*codes*/,
                                      const Eigen::Affine2d& /*plane_from_cell*/) {
  refuse("prescription");
}

ValuedPolygons readValues(const std::filesystem::path& path, const std::string& /*layer*/,
                          const std::string& /*field*/) {
  refuse(path.string());
}

std::vector<NamedPolygon> readPolygons(const std::filesystem::path& path, const Crs& /*crs*/) {
  refuse(path.string());
}

}  // namespace agricolmap::io
