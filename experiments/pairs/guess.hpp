// Guesses that are wrong by as much as a suite says, and what methods are told of them.
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/search_space.hpp"

namespace agricolmap::experiments {

/// What is made wrong with an exact guess. It has these sizes exactly; directions and signs are
/// drawn.
struct AddedError {
  double setting = 0.0;      ///< what the suite varies, in its own unit
  double translation = 0.0;  ///< [m], horizontal
  double heading = 0.0;      ///< [rad]
  double scale = 0.0;        ///< of the moving cloud's x and of its y, relative
  /// What methods are told: the paper's limits, or wider where the error goes beyond them.
  PriorUncertainty told() const;
};

/// The moving cloud with its scale error, as a matrix: undisturbed file → disturbed file, about the
/// cloud's middle. The signs depend on the seed and the size alone, so that all guesses of that
/// size share a cloud.
Eigen::Affine3d scaleError(const AddedError& error, int seed, const Cloud& moving);
/// The exact guess made wrong by the translation (in a random direction) and heading (of random
/// sign), about the moving cloud's middle. They depend on the seed, the suite and the setting.
Eigen::Affine3d wrongGuess(const std::string& suite, const AddedError& error, int seed,
                           const Cloud& moving, const Eigen::Affine3d& exact);
/// Moves the points of a cloud within its file's coordinates.
void transformCloud(Cloud& cloud, const Eigen::Affine3d& moved_from_file);

/// `T_M,HEADING_DEG,SCALE_PERCENT`, or `none` for no guess; `,unit` where the file's is unknown.
std::string toldText(const PriorUncertainty& told);

}  // namespace agricolmap::experiments
