// What a view would see from straight above: surface height and colour on a fine raster.
#pragma once

#include <array>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/simulate/scene.hpp"

namespace agricolmap {

/// Which of the two flights or drives a picture belongs to.
enum class View { kUav = 0, kUgv = 1 };

/// Linear colour, 0…1.
using Colour = std::array<float, 3>;

struct Canopy {
  GridFrame frame;        ///< field frame
  Raster<float> ground;   ///< bare soil [m]
  Raster<float> height;   ///< top surface [m]
  Raster<Colour> colour;  ///< lit by the view's sun, shadows included
};

/// Rasterises the scene as it stands in `view` over `window`, cells of `cell` metres.
Canopy renderCanopy(const Scene& scene, View view, const Eigen::AlignedBox2d& window, double cell);

}  // namespace agricolmap
