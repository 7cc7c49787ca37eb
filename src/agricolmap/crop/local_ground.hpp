// Heights above the soil that shows between plants, where a map has heights above a plane only.
#pragma once

#include "agricolmap/crop/view.hpp"

namespace agricolmap::crop {

struct GroundOptions {
  double tile = 0.75;  ///< side of the squares whose bare cells' median is the ground [m]
};

/// Heights less the ground's, which is the median of what is surely bare in each square, bilinear
/// between their centres; squares that show too little soil take their neighbours'. NaN where the
/// view has no height.
Raster<float> heightAboveGround(const View& view, const Greenness& greenness,
                                const GroundOptions& options = {});

/// How far heights tell plants from soil.
struct HeightContrast {
  double plants = 0.0;  ///< median height of what is called plant [m]
  double noise = 0.0;   ///< robust deviation of the soil's [m]
  bool tells() const { return plants > 4.0 * noise; }
};
HeightContrast heightContrast(const Raster<float>& height, const Greenness& greenness);

/// What plants are looked for in: the greenness, counted by height where that tells plants from
/// soil, as leaves that hang far from their stem are low and stems are where it is high.
Raster<float> standing(const Raster<float>& height, const Greenness& greenness);

}  // namespace agricolmap::crop
