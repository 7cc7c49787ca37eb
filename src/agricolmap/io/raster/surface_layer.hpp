// A surface model on the grid of layers: southernmost row first, in metres whatever the file says.
#pragma once

#include <optional>

#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/raster_file.hpp"

namespace agricolmap::io {

struct SurfaceLayer {
  Raster<float> height;  ///< [m], NaN where there is none
  std::vector<std::string> warnings;
};

/// Where a layer's file lies.
RasterPlace placeOf(const LayerShape& shape);

/// Surface models of others have units, scales and nodata of many kinds: heights are read as
/// readHeights does. Throws InputError as that.
SurfaceLayer readSurfaceLayer(const std::filesystem::path& path, const LayerShape& shape,
                              const CellWindow& window);

/// All of it.
SurfaceLayer readSurfaceLayer(const std::filesystem::path& path, const LayerShape& shape);

}  // namespace agricolmap::io
