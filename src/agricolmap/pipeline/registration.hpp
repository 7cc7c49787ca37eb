// The pipeline: from two clouds and an initial guess to a transformation and a verdict.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/core/transform.hpp"
#include "agricolmap/pipeline/judgement.hpp"
#include "agricolmap/pipeline/located.hpp"
#include "agricolmap/pipeline/maps.hpp"

namespace agricolmap::pipeline {

/// How an answer was come by.
struct Trace {
  std::size_t attempts = 0;  ///< searches, one after the other
  Located located;           ///< by the search that the answer is from
  std::size_t held = 0;      ///< placements that held when refined
  std::optional<CpdReport> cpd;
  std::optional<bool> straightened;       ///< see Measured
  std::vector<pieces::PiecePose> pieces;  ///< of a long strip, in order along its path
};

/// Where a moving map was placed, in the levelled frames.
struct Outcome {
  verdict::Verdict verdict;
  std::optional<Placed> placed;             ///< nothing: no answer at all, and the verdict says why
  std::vector<refine::RefinedPose> rivals;  ///< other places that held when refined
  Trace trace;
};

/// The answer in the coordinates of the files.
struct Transform {
  /// Moving file coordinates → fixed file coordinates [m].
  Eigen::Affine3d fixed_from_moving = Eigen::Affine3d::Identity();
  /// The same between the local frames (about the clouds' origins).
  Eigen::Affine3d local_fixed_from_moving = Eigen::Affine3d::Identity();

  // Parts, relative to the initial guess, at the middle of the moving map.
  HorizontalParts parts;  ///< yaw [rad], scales along the moving file's axes
  double vertical_scale = 1.0;
  Eigen::Vector2d tilt =
      Eigen::Vector2d::Zero();  ///< slope between the ground planes [rad], x and y
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();   ///< of the moving map's middle [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< that middle, fixed file coordinates [m]
};

/// Another place where the moving map fits.
struct Alternative {
  /// Moving file → fixed file coordinates [m].
  Eigen::Affine3d fixed_from_moving = Eigen::Affine3d::Identity();
  double significance = 0.0;  ///< see StripScore
};

/// What a registration found. A registration that fails has no `placed` and no `transform`.
struct Registration {
  verdict::Verdict verdict;
  std::optional<Transform> transform;
  std::optional<Placed> placed;  ///< what the transform rests on, wherever there is one
  /// Other places, listed when the status is ambiguous, most significant first.
  std::vector<Alternative> alternatives;
  Trace trace;
  PairMaps maps;  ///< for pictures and reports

  /// Whether the moving cloud is laid by more than the transform: a bend that is followed.
  bool bent() const { return placed && placed->followed; }
};

/// Registers `moving` into `fixed`, which passes by four times or more, less often where other
/// strips were registered to the same FixedCloud before. `guess`: moving file coordinates → fixed
/// file coordinates. Throws InputError for clouds that cannot be used, UsageError for options
/// outside their limits, Interrupted when the monitor's token asks to stop. A registration that
/// fails is a rejected result, not an exception. `locator` stands in for the search that the
/// options name; empty: theirs. `path`: places of the robot in the order of driving, moving file
/// coordinates; empty: as the strip's shape tells.
Registration registerClouds(const FixedCloud& fixed, const Cloud& moving,
                            const Eigen::Affine3d& guess, const RegistrationOptions& options,
                            Monitor& monitor, const Locator& locator = {},
                            const std::vector<Eigen::Vector3d>& path = {});
Registration registerClouds(const PointStream& fixed, const Cloud& moving,
                            const Eigen::Affine3d& guess, const RegistrationOptions& options,
                            Monitor& monitor, const Locator& locator = {},
                            const std::vector<Eigen::Vector3d>& path = {});
Registration registerClouds(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                            const RegistrationOptions& options, Monitor& monitor,
                            const Locator& locator = {},
                            const std::vector<Eigen::Vector3d>& path = {});

}  // namespace agricolmap::pipeline
