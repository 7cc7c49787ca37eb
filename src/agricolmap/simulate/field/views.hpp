// The two sensors: from a lit canvas to points of the field with colours.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/simulate/field/canvas.hpp"
#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap::simulate {

/// Points in the field frame [m].
struct FieldPoints {
  std::vector<Eigen::Vector3f> xyz;
  std::vector<Rgb> rgb;
  std::size_t there = static_cast<std::size_t>(-1);  ///< points from this on are of the way back
};

/// Parts one after another.
FieldPoints joinPoints(const std::vector<FieldPoints>& parts);

/// The drone's view of a canvas that covers the field: blurred, a little too low, with holes.
FieldPoints senseFromAbove(const Canvas& canvas, const UavOptions& options, std::uint64_t seed);

/// The robot's view along the canvas's x axis. The strip is centred in the canvas, which is larger
/// so that plants beside the strip can hide what is in it. Coordinates are metres along the strip
/// from its beginning, metres to the left of its middle, and the field's height.
FieldPoints senseFromGround(const Canvas& canvas, const UgvOptions& options, std::uint64_t seed);

}  // namespace agricolmap::simulate
