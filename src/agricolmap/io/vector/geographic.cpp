#include <ogr_spatialref.h>

#include <memory>

#include "agricolmap/io/vector/ogr_support.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"

namespace agricolmap::io {

namespace {

OGRSpatialReference longitudeLatitude() {
  OGRSpatialReference srs;
  srs.importFromEPSG(4326);
  srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return srs;
}

/// Nothing where one of them cannot be brought there.
std::optional<std::vector<Eigen::Vector2d>> brought(const OGRSpatialReference& from,
                                                    const OGRSpatialReference& to,
                                                    const std::vector<Eigen::Vector2d>& points) {
  const std::unique_ptr<OGRCoordinateTransformation> transform(
      OGRCreateCoordinateTransformation(&from, &to));
  if (!transform) return std::nullopt;
  std::vector<Eigen::Vector2d> result = points;
  for (Eigen::Vector2d& point : result) {
    if (transform->Transform(1, &point.x(), &point.y()) == FALSE) return std::nullopt;
  }
  return result;
}

}  // namespace

std::optional<std::vector<Eigen::Vector2d>> geographic(const Crs& crs,
                                                       const std::vector<Eigen::Vector2d>& points) {
  const QuietGdal quiet;
  const std::optional<OGRSpatialReference> from = horizontalSrs(crs);
  if (!from) return std::nullopt;
  return brought(*from, longitudeLatitude(), points);
}

std::optional<std::vector<Eigen::Vector2d>> fromGeographic(
    const Crs& crs, const std::vector<Eigen::Vector2d>& points) {
  const QuietGdal quiet;
  const std::optional<OGRSpatialReference> to = horizontalSrs(crs);
  if (!to) return std::nullopt;
  return brought(longitudeLatitude(), *to, points);
}

Crs geographicCrs() {
  const QuietGdal quiet;
  return crsFrom(longitudeLatitude());
}

}  // namespace agricolmap::io
