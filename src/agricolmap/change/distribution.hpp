// How many cells changed by how much.
#pragma once

#include <vector>

#include "agricolmap/change/height_change.hpp"

namespace agricolmap::change {

struct Distribution {
  struct Bin {
    double sure = 0.0;    ///< cells whose change exceeds their level of detection
    double unsure = 0.0;  ///< the others
  };
  double reach = 0.0;     ///< the bins span −reach…reach evenly [m]
  std::vector<Bin> bins;  ///< the outermost have what lies beyond, too
};

/// A round number that nearly all changes are within, 2 cm at least [m].
double reachOf(const Raster<float>& change);

Distribution distributionOf(const HeightChange& change, int bins);

}  // namespace agricolmap::change
