// GDAL's coordinate systems, quiet and with x before y.
#pragma once

#include <cpl_error.h>
#include <ogr_spatialref.h>

#include <optional>
#include <span>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/las/las_header.hpp"

namespace agricolmap::io {

/// Keeps GDAL and PROJ from printing in this thread.
struct QuietGdal {
  QuietGdal() { CPLPushErrorHandler(CPLQuietErrorHandler); }
  ~QuietGdal() { CPLPopErrorHandler(); }
  QuietGdal(const QuietGdal&) = delete;
  QuietGdal& operator=(const QuietGdal&) = delete;
};

/// Throws an internal error when PROJ does not find its database: without it, what it knows of
/// coordinate systems is not enough to tell metres from feet.
void requireProjDatabase();

/// From anything that GDAL understands; nothing when it does not.
std::optional<OGRSpatialReference> srsFrom(const std::string& definition);

/// From the GeoTIFF keys (records 34735 to 34737) of a LAS file; nothing when they make no system.
std::optional<OGRSpatialReference> srsFromGeoKeys(const LasHeader& header);

/// Metres per unit of heights, where the GeoTIFF keys give one.
std::optional<double> verticalUnitOf(const LasHeader& header);

/// With its units; heights that say none have that of the plane.
Crs crsFrom(const OGRSpatialReference& srs);

/// Without heights.
OGRSpatialReference horizontalOf(const OGRSpatialReference& srs);

}  // namespace agricolmap::io
