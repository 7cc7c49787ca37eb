// Sun and sky: where the sun stands, and how much light falls into each cell.
#pragma once

#include "agricolmap/simulate/field/canvas.hpp"

namespace agricolmap::simulate {

/// Unit vector to the sun (east, north, up) at 46° north in early June at a solar time [h].
Eigen::Vector3d sunDirection(double solar_hour);

/// Turns the cells' cosines into sunlight (0 in shadow), computes those of bare soil from its slope
/// and fills `sky`. `overcast` is the sky's share of the light.
void lightCanvas(Canvas& canvas, const Eigen::Vector3d& sun, double overcast);

}  // namespace agricolmap::simulate
