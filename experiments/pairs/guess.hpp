// The experiments of the comparison: by how much the initial guess is wrong, setting by setting.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/locate/association.hpp"

namespace agricolmap::experiments {

/// One setting of an experiment. What is wrong with the guess has these sizes exactly; directions
/// and signs are drawn.
struct Cell {
  std::string experiment;
  double setting = 0.0;      ///< what the experiment varies, in its own unit
  double translation = 0.0;  ///< [m], horizontal
  double heading = 0.0;      ///< [rad]
  double scale = 0.0;        ///< of the moving cloud's x and of its y, relative
  /// `--prior-sigma` of every method: the paper's, or wider where the setting goes beyond it.
  std::string priorText() const;
};

/// Cells in which one error rises and all else stays.
struct Curve {
  std::string experiment;
  double scale = 0.0;  ///< of all its cells; 0 where the scale itself rises
  bool rising = true;  ///< false: cells that have no order
  std::vector<Cell> cells;
};

/// translation, heading, joint, accuracy, inliers.
std::vector<std::string> experimentNames();
/// `quick`: few settings. Throws UsageError, listing the known names, for an unknown one.
std::vector<Curve> curvesOf(const std::string& experiment, bool quick);
/// Whether the method takes part: only methods that match points have inliers.
bool takesPart(const std::string& method, const std::string& experiment);

/// FNV-1a, for random streams by name and to tell options apart.
std::uint64_t hashText(const std::string& text);

/// The moving cloud with its scale error, as a matrix: undisturbed file → disturbed file, about the
/// cloud's middle. The signs depend on the seed and the size alone, so that all cells of that size
/// share a file.
Eigen::Affine3d scaleError(const Cell& cell, int seed, const Cloud& moving);
/// The exact guess made wrong by the cell's translation (in a random direction) and heading (of
/// random sign), about the moving cloud's middle. They depend on the seed, the experiment and the
/// setting.
Eigen::Affine3d wrongGuess(const Cell& cell, int seed, const Cloud& moving,
                           const Eigen::Affine3d& exact);
/// Moves the points of a cloud within its file's coordinates.
void transformCloud(Cloud& cloud, const Eigen::Affine3d& moved_from_file);

}  // namespace agricolmap::experiments
