// A map as a camera saw it, for a page to show.
#pragma once

#include <cstdint>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/raster.hpp"

namespace agricolmap::report {

/// Empty rasters: nobody knows its colours.
struct ColourMap {
  GridFrame frame;  ///< about the origin of what it is shown with [m]
  Raster<Rgb> colour;
  Raster<std::uint8_t> known;  ///< 0 where nothing was seen
};

}  // namespace agricolmap::report
