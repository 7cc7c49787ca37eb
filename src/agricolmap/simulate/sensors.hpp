// From a view's surface to the points a sensor delivers, still at their true places.
#pragma once

#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/simulate/canopy.hpp"

namespace agricolmap {

/// A point where it belongs and where the sensor's map has it, field frame [m]. The difference is what
/// bends the map (drift, dome); noise is in both.
struct SensedPoint {
  Eigen::Vector3d truth;
  Eigen::Vector3d measured;
  Rgb colour;
};

/// Photogrammetry of the whole field from above: smoothed surface, canopy too low, dome, holes.
std::vector<SensedPoint> senseFromAbove(const Canopy& canopy, const SimulationOptions& options,
                                        std::uint64_t seed);

/// The strip's own frame: x along the path, y to the left, origin at its middle.
struct StripPose {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< field frame [m]
  double heading = 0.0;                              ///< of the path [rad]
};

/// A forward-looking camera driven along the strip: hidden cells are missing, plants show their
/// sides, density falls off sideways, the map drifts smoothly along the path.
std::vector<SensedPoint> senseFromGround(const Canopy& canopy, const StripPose& strip,
                                         const SimulationOptions& options, std::uint64_t seed);

}  // namespace agricolmap
