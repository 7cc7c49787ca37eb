// How well two maps fit under a pose, whatever it was found by.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::refine {

struct Fit {
  double overlap = 0.0;      ///< share of the moving map's seen cells that the fixed map sees
  double correlation = 0.0;  ///< of the signals of both channels over the overlap
};

/// `fixed`, `moving`: of the same cell size; the pose is levelled moving → levelled fixed.
Fit fitOf(const map::SignalMap& fixed, const map::SignalMap& moving, const Eigen::Affine2d& pose);

}  // namespace agricolmap::refine
