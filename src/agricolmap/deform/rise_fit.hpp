// How the strip's height drifts along the path: a spline through what the ground of the two maps
// differs by, as stiff as left-out blocks would have it, and only if these confirm it.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "agricolmap/deform/deformation.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/refine/vertical.hpp"

namespace agricolmap::deform {

struct RiseFit {
  Eigen::VectorXd coefficients;  ///< of the spline of the deformation [m]
  double gain = 0.0;             ///< squares that left-out blocks are spared, over their error
  double deviation = 0.0;        ///< of the curve, root mean square along the path [m]
};

/// On top of `heights`, where `pose` and the deformation's horizontal part lay the moving map.
/// Only bins in which both maps show flat ground count: what a canopy hides, or loses to a drone's
/// blur, drifts along a strip, too. Nothing where these are too few.
std::optional<RiseFit> fitRise(const map::GridMap& fixed, const map::GridMap& moving,
                               const Eigen::Affine2d& pose, const refine::VerticalResult& heights,
                               const Deformation& deformation);

}  // namespace agricolmap::deform
