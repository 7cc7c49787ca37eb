// What crop facts are read from, and how green it is.
#pragma once

#include <limits>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/map/vegetation.hpp"

namespace agricolmap::crop {

inline constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// Layers of a map, which must outlive the view; all have the frame's size, NaN where nothing is
/// known.
struct View {
  GridFrame frame;              ///< [m]
  const Raster<float>& exg;     ///< chromatic Excess Green
  const Raster<float>& height;  ///< of the surface above the ground [m]; empty: not known
};

/// How much of a cell is plant.
struct Greenness {
  map::VegetationThreshold threshold;
  /// (Excess Green − soil's mean) / (plants' mean − soil's), −0.5…1.5; NaN where unknown. Summed
  /// up it is an area, also of plants no larger than a cell.
  Raster<float> green;
  float leaf = 0.5F;  ///< of `green`, above which a cell is called plant

  bool known() const { return threshold.status == map::VegetationStatus::kOk; }
};

/// By the threshold that the view's own Excess Green gives. `green` is empty unless plants stand
/// out from soil.
Greenness greennessOf(const View& view, const map::VegetationOptions& options = {});

/// Mean of the known cells under a square of `step` × `step`; NaN where fewer than a quarter are.
struct CoarseGreen {
  GridFrame frame;
  Raster<float> green;
};
CoarseGreen coarseGreen(const GridFrame& frame, const Raster<float>& green, int step);

}  // namespace agricolmap::crop
