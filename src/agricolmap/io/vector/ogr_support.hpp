// What all of io/vector needs of OGR.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <optional>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/crs/srs.hpp"

namespace agricolmap::io {

/// Once per process, whoever asks first.
void registerDrivers();

/// x before y, without heights; nothing where `crs` is empty or not understood.
std::optional<OGRSpatialReference> horizontalSrs(const Crs& crs);

/// An unknown plane, as GeoPackage calls it; of GDAL 3.6 a layer without any has unknown degrees.
OGRSpatialReference unknownPlane();

/// What a layer says of its coordinates; null where it says that they are undefined, too.
const OGRSpatialReference* srsOf(OGRLayer& layer);

}  // namespace agricolmap::io
