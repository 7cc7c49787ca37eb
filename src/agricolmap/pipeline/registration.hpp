// The pipeline: from two clouds and an initial guess to a transformation and a verdict.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/pipeline/pair_maps.hpp"
#include "agricolmap/pipeline/placing.hpp"

namespace agricolmap::pipeline {

/// What a registration found. `status == kRejected` with `has_transform == false`: no answer at
/// all.
struct Registration : PairOutcome {
  /// Moving file coordinates → fixed file coordinates [m].
  Eigen::Affine3d fixed_from_moving;
  /// The same between the local frames (about the clouds' origins).
  Eigen::Affine3d local_fixed_from_moving;

  // Parts, relative to the initial guess, at the middle of the moving map.
  HorizontalParts parts;  ///< yaw [rad], scales along the moving file's axes
  double vertical_scale = 1.0;
  Eigen::Vector2d tilt =
      Eigen::Vector2d::Zero();  ///< slope between the ground planes [rad], x and y
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();   ///< of the moving map's middle [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< that middle, fixed file coordinates [m]

  // Kept for pictures and reports.
  PairFrames frames;
  map::GridMap fixed_map;
  map::GridMap moving_map;
  SearchSpace space;
};

/// Registers `moving` into `fixed`. `guess`: moving file coordinates → fixed file coordinates.
/// Throws InputError for clouds that cannot be used, UsageError for options outside their limits,
/// Interrupted. A registration that fails is a rejected result, not an exception. `association`
/// lets another data association stand in for the one that the options name, in the chain unchanged
/// otherwise; nullptr: theirs.
Registration registerClouds(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                            const RegistrationOptions& options, StageTimes& times,
                            const locate::Association* association = nullptr);

}  // namespace agricolmap::pipeline
