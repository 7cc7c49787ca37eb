// Simulated pairs of clouds with exact truth: a drone's map of a crop field and a ground robot's
// strip of it, taken at another time, from another side, with another camera.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap {

struct SimulatedPair {
  Cloud uav;  ///< metrically right but for its own noise and dome
  Cloud ugv;
  /// Per UGV point, where it lies in the UAV file's coordinates [m]: the recorded point, sensor
  /// noise included, without drift and without the errors of scale, level and geotag.
  std::vector<Eigen::Vector3d> truth;
  Eigen::Affine3d best_affine;  ///< UGV file → UAV file: least squares fit to `truth`
  Eigen::Affine3d nominal;      ///< UGV file → UAV file: exact but for drift
  Eigen::Affine3d prior;        ///< UGV file → UAV file: the initial guess
  Eigen::Vector3d strip_centre = Eigen::Vector3d::Zero();  ///< UAV file coordinates [m]
  double strip_heading = 0.0;  ///< direction of travel in the UAV file [rad]
  double row_heading = 0.0;    ///< direction of the UAV field's rows [rad]
  /// False when the strip was taken from another field; `truth` is then where it would have lain.
  bool overlaps = true;
};

/// Equal options give equal bits on any number of threads. Throws UsageError when an option is
/// outside its limits or the strip does not fit into the field.
SimulatedPair simulatePair(const SimulationOptions& options);

}  // namespace agricolmap
