// A simulated UAV/UGV pair with exact truth.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/simulate/options.hpp"
#include "agricolmap/simulate/sensors.hpp"

namespace agricolmap {

/// Two clouds in their own file coordinates, and where the moving one's points truly belong.
struct SimulatedPair {
  Cloud uav;
  Cloud ugv;
  Eigen::Affine3d world_from_uav;      ///< offset.xyz of the UAV cloud
  Eigen::Affine3d world_from_ugv;      ///< offset.xyz of the UGV cloud, as wrong as a geotag
  Eigen::Affine3d prior;               ///< UGV file → UAV file, what the two offsets give
  Eigen::Affine3d nominal;             ///< UGV file → UAV file, exact but for drift and noise
  std::vector<Eigen::Vector3d> truth;  ///< per UGV point: its place in UAV file coordinates
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< strip's middle, UAV file coordinates [m]
  bool overlaps = true;                              ///< false: the strip is from another field
};

/// Simulates; equal options give equal pairs on any number of threads.
SimulatedPair simulatePair(const SimulationOptions& options);

/// Turns sensed points (field frame) into a pair: file frames, geotag error, truth.
SimulatedPair assemblePair(const std::vector<SensedPoint>& uav, const std::vector<SensedPoint>& ugv,
                           const StripPose& strip, const SimulationOptions& options);

/// Where the strip lies: a place in `extent` drawn from the seed, parallel to `row_heading` but for
/// the option's heading, as far inside as the margin asks and the field allows.
StripPose placeStrip(const Eigen::AlignedBox2d& extent, double row_heading,
                     const SimulationOptions& options);

}  // namespace agricolmap
