#include "agricolmap/io/vector/ogr_support.hpp"

#include <mutex>

namespace agricolmap::io {

void registerDrivers() {
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
}

std::optional<OGRSpatialReference> horizontalSrs(const Crs& crs) {
  if (crs.wkt.empty()) return std::nullopt;
  std::optional<OGRSpatialReference> srs = srsFrom(crs.wkt);
  if (!srs) return std::nullopt;
  OGRSpatialReference horizontal = horizontalOf(*srs);
  horizontal.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return horizontal;
}

}  // namespace agricolmap::io
