// What must hold of the places of rasters that are laid over each other.
#pragma once

#include <optional>
#include <string>

#include "agricolmap/io/raster/raster_file.hpp"

namespace agricolmap::io {

/// Throws InputError unless the raster `name` says where it lies.
void checkGeoreference(const std::string& name, const RasterPlace& place);

/// Throws InputError unless the raster `name` is georeferenced in metres.
void checkMetres(const std::string& name, const RasterPlace& place);

/// Whether both coordinate systems have the same horizontal part. Throws InputError for one that is
/// not understood; names are of what has them.
bool sameHorizontally(const std::string& name, const std::string& wkt,
                      const std::string& other_name, const std::string& other_wkt);

/// Throws InputError when both rasters say their coordinate systems and these differ. A warning
/// when one does not say.
std::optional<std::string> checkSameCrs(const std::string& name, const RasterPlace& place,
                                        const std::string& other_name,
                                        const RasterPlace& other_place);

/// "west..east, south..north" of a georeferenced raster, for messages [m].
std::string extentOf(const RasterPlace& place, int rows, int cols);

}  // namespace agricolmap::io
