// The layers of a shared map as Cloud-Optimised GeoTIFFs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "agricolmap/fuse/shared_map.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::fuse {

/// Where the file of that name, relative to the map's folder, is to be written.
using Place = std::function<io::OutputPath(const std::string& name)>;

/// The points of the map's strips, in their order there.
using StripPoints = std::vector<const PointStream*>;

/// Writes `layers/NAME.tif` over the whole field and, where strips own cells, in the strips'
/// cells, `fine/STRIP_heights.tif` (surface, ground), `fine/STRIP.tif` (plant height, Excess Green,
/// cover, density) and `fine/STRIP_colour.tif`; then `fine/LAYER.vrt`, the whole field in the
/// strips' cells, which refers to all of these. Heights are left out where the clouds have none.
/// Returns their names. Throws OutputError, and UsageError in a build without GDAL.
std::vector<std::string> writeLayers(const Place& place, const SharedMap& map,
                                     const StripPoints& points, const FuseOptions& options,
                                     const Crs& crs);

}  // namespace agricolmap::fuse
