#include "agricolmap/io/raster/raster_place.hpp"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/crs/srs.hpp"

namespace agricolmap::io {
namespace {

constexpr double kMetreTolerance = 1e-6;

OGRSpatialReference horizontalCrs(const std::string& wkt, const std::string& name) {
  OGRSpatialReference crs;
  if (crs.importFromWkt(wkt.c_str()) != OGRERR_NONE) {
    throw InputError(fmt::format("{}: its coordinate system cannot be understood", name));
  }
  if (crs.IsCompound() != 0) crs.StripVertical();
  return crs;
}

bool areSame(const OGRSpatialReference& one, const OGRSpatialReference& other) {
  const char* const lenient[] = {"IGNORE_DATA_AXIS_TO_SRS_AXIS_MAPPING=YES", "CRITERION=EQUIVALENT",
                                 nullptr};
  return one.IsSame(&other, lenient) != 0;
}

}  // namespace

bool sameHorizontally(const std::string& name, const std::string& wkt,
                      const std::string& other_name, const std::string& other_wkt) {
  return areSame(horizontalCrs(wkt, name), horizontalCrs(other_wkt, other_name));
}

void checkGeoreference(const std::string& name, const RasterPlace& place) {
  if (!place.world_from_pixel) {
    throw InputError(fmt::format(
        "{}: is not georeferenced; give it its place with gdal_translate -a_ullr and -a_srs",
        name));
  }
  if (std::abs(place.world_from_pixel->linear().determinant()) <= 0.0) {
    throw InputError(fmt::format("{}: its georeference is degenerate", name));
  }
}

void checkMetres(const std::string& name, const RasterPlace& place) {
  checkGeoreference(name, place);
  if (place.crs.empty()) return;
  requireProjDatabase();
  const OGRSpatialReference crs = horizontalCrs(place.crs, name);
  if (crs.IsGeographic() != 0 || crs.IsGeocentric() != 0) {
    throw InputError(fmt::format(
        "{}: its coordinates are degrees, not metres; reproject it: gdalwarp -t_srs EPSG:326<zone> "
        "(UTM north; 327<zone> south)",
        name));
  }
  const char* unit = nullptr;
  const double metres = crs.GetLinearUnits(&unit);
  if (std::abs(metres - 1.0) > kMetreTolerance) {
    throw InputError(
        fmt::format("{}: its coordinates are in units of {} m ({}); reproject it to metres with "
                    "gdalwarp -t_srs",
                    name, metres, unit == nullptr ? "unnamed" : unit));
  }
  checkGroundScale(name, crsFrom(crs), place.world_from_pixel->translation());
}

std::optional<std::string> checkSameCrs(const std::string& name, const RasterPlace& place,
                                        const std::string& other_name,
                                        const RasterPlace& other_place) {
  if (place.crs.empty() || other_place.crs.empty()) {
    return fmt::format(
        "{}: coordinate system not given; taken as metres in the same one for both rasters",
        place.crs.empty() ? name : other_name);
  }
  const OGRSpatialReference one = horizontalCrs(place.crs, name);
  const OGRSpatialReference other = horizontalCrs(other_place.crs, other_name);
  if (!areSame(one, other)) {
    throw InputError(fmt::format(
        "{} ({}) and {} ({}) have different coordinate systems; reproject one with gdalwarp -t_srs",
        name, one.GetName(), other_name, other.GetName()));
  }
  return std::nullopt;
}

}  // namespace agricolmap::io
