// Stages level and grid: from two clouds and an initial guess to levelled, gridded maps.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/map/footprint.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/level.hpp"
#include "agricolmap/pipeline/fixed_cloud.hpp"

namespace agricolmap::pipeline {

/// Frames of a pair. Local frames are the clouds' own axes about their double origins.
struct PairFrames {
  /// By how much both levelled frames are turned against the fixed file's axes, counter-clockwise
  /// [rad]: maps of a long strip lie along it, so that they cost what it is long.
  double turn = 0.0;
  Eigen::Affine3d levelled_from_fixed;   ///< fixed local → fixed levelled [m]
  Eigen::Affine3d levelled_from_moving;  ///< moving local → initial guess → moving levelled [m]
  map::Levelling fixed;
  map::Levelling moving;
  map::Footprint fixed_footprint;  ///< in the levelled frames
  map::Footprint moving_footprint;
};

/// Mean of the cloud's points in its file's coordinates [m]; one pass.
Eigen::Vector3d meanOf(const PointStream& cloud);
Eigen::Vector3d meanOf(const Cloud& cloud);

/// Where the guess says nothing about the place, the middles of the clouds are laid together, so
/// that all that follows counts from there, however far apart the files' coordinates are.
Eigen::Affine3d centredGuess(const FixedCloud& fixed, const Cloud& moving,
                             const Eigen::Affine3d& guess, const PriorUncertainty& uncertainty);

/// The turn that lays a strip of more than `from` [m] along the x axis under the guess; none where
/// it is shorter, hardly longer than wide, or the guess leaves its heading open.
double turnAlong(const CloudFacts& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const PriorUncertainty& uncertainty, double from);

/// Levels the fixed cloud and finds where its points are.
void levelFixed(const FixedCloud& fixed, const map::LevelOptions& options, PairFrames& frames);
/// Levels the moving cloud under a guess (moving file → fixed file coordinates) and finds where its
/// points are.
void levelMoving(const CloudFacts& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const map::LevelOptions& options, PairFrames& frames);

/// Throws InputError when the moving map's bounds are far larger than the fixed map's.
void requirePlausibleExtents(const CloudFacts& fixed, const Cloud& moving,
                             const map::Box2& fixed_box, const map::Box2& moving_box);

/// What is searched when the moving map has these bounds.
SearchSpace searchSpace(const map::Box2& moving, const PairFrames& frames,
                        const PriorUncertainty& uncertainty);

/// The part of the fixed frame that a moving map of these bounds can reach, and `rim` more [m].
map::Box2 reachableWindow(const map::Box2& moving, const SearchSpace& space, double rim);

}  // namespace agricolmap::pipeline
