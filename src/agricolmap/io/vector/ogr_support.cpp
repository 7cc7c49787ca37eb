#include "agricolmap/io/vector/ogr_support.hpp"

#include <mutex>
#include <string_view>

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

OGRSpatialReference unknownPlane() {
  OGRSpatialReference plane;
  plane.SetLocalCS("Undefined Cartesian SRS");
  plane.SetLinearUnits(SRS_UL_METER, 1.0);
  return plane;
}

const OGRSpatialReference* srsOf(OGRLayer& layer) {
  const OGRSpatialReference* srs = layer.GetSpatialRef();
  if (srs == nullptr) return nullptr;
  // The names that GeoPackage's specification gives to those that are none, and GDAL 3.9's.
  const char* name = srs->GetName();
  return name != nullptr && std::string_view(name).starts_with("Undefined ") ? nullptr : srs;
}

}  // namespace agricolmap::io
