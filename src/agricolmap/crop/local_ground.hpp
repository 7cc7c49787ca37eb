// Heights above the soil that shows between plants, where a map has heights above a plane only.
#pragma once

#include "agricolmap/crop/view.hpp"

namespace agricolmap::crop {

struct GroundOptions {
  double tile = 0.75;  ///< side of the squares whose bare cells' median is the ground [m]
};

/// Heights less the ground's, which is the median of what is surely bare in each square, bilinear
/// between their centres; squares that show too little soil take their neighbours'. NaN where the
/// view has no height, empty where it has none at all.
Raster<float> heightAboveGround(const View& view, const Greenness& greenness,
                                const GroundOptions& options = {});

}  // namespace agricolmap::crop
