// What all of io/vector needs of OGR.
#pragma once

#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <optional>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/crs/srs.hpp"

namespace agricolmap::io {

/// Once per process, whoever asks first.
void registerDrivers();

/// x before y, without heights; nothing where `crs` is empty or not understood.
std::optional<OGRSpatialReference> horizontalSrs(const Crs& crs);

}  // namespace agricolmap::io
