// The error of the initial guess and the affines that go with it.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap::simulate {

/// UGV file → UAV file.
struct Geotag {
  Eigen::Affine3d nominal = Eigen::Affine3d::Identity();  ///< exact, but for drift
  Eigen::Affine3d prior = Eigen::Affine3d::Identity();    ///< the initial guess
};

/// Draws the errors of a strip that is centred at `centre` (UAV file coordinates), in a field whose
/// rows lie one beside the other in the direction `across_rows` [rad].
Geotag drawGeotag(const GeotagOptions& options, const Eigen::Vector3d& centre, double across_rows,
                  std::uint64_t seed);

}  // namespace agricolmap::simulate
