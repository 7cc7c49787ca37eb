// The styles beside the GeoTIFFs of a map and of a change: QGIS takes NAME.qml for NAME.tif
// and NAME.vrt.
#pragma once

#include <functional>
#include <string>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/fuse/shared_map.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::report {

/// Of `layers/` and of `fine/`, in the colours of the map's page. `place`: where the file of that
/// name, relative to the map's folder, is to be written. Surface, ground and date stay grey.
void writeMapStyles(const std::function<io::OutputPath(const std::string& name)>& place,
                    const fuse::SharedMap& map);

/// Of the file `name` (without ending) in `dir`, whose first band is a change up to `reach`.
void writeChangeStyle(const io::OutputPath& dir, const std::string& name, double reach,
                      const std::string& unit);

}  // namespace agricolmap::report
