// What strips show in cells of their own, which are finer than the map's.
#pragma once

#include "agricolmap/core/raster.hpp"
#include "agricolmap/fuse/shared_map.hpp"

namespace agricolmap::fuse {

/// What a strip shows where it owns the cells of the map; NaN elsewhere. Heights as in Layers.
struct FineLayers {
  Raster<float> surface, ground, plant_height, exg, cover, density;
  Raster<Rgb> colour;
  Raster<std::uint8_t> mask;  ///< 255 where it shows something
};

/// Of strip number `strip`, which `own` is the fineMap of. `match_colours`: as FuseOptions.
FineLayers fineLayers(const SharedMap& map, std::size_t strip, const map::GridMap& own,
                      bool match_colours);

}  // namespace agricolmap::fuse
