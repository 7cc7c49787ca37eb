// Stage 7b, at its end: the affine that lies closest to all parts of the strip. Where drift has
// bent it, no affine fits everywhere: the dense refinement, which sees a few centimetres at its
// finest cells, settles on the part that fits and lets the ends go. Blocks, each moved alone, say
// how far off every part is, and count alike.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "agricolmap/2_grid/signal_map.hpp"
#include "agricolmap/core/options.hpp"

namespace agricolmap {

struct BlockRefineOptions {
  int rounds = 2;       ///< of moving the blocks and laying the strip by them
  double side = 0.6;    ///< of a block [m]
  double robust = 2.0;  ///< blocks beyond this many deviations fade (Cauchy)
  double drift = 0.02;  ///< so far a bent strip's parts may lie apart without fading [m]
  double trust = 0.02;  ///< expected error of the given pose at a corner [m]
};
void describe(OptionTable& table, BlockRefineOptions& options);

/// Least squares over the blocks' shifts for a horizontal affine; what the blocks leave open (a
/// strip one block wide says nothing of its scale across) stays as in `pose`. Nothing when fewer
/// than four blocks can be compared. Both maps at the same cell size, levelled frames.
std::optional<Eigen::Affine2d> refineByBlocks(const SignalMap& fixed, const SignalMap& moving,
                                              const Eigen::Affine2d& pose,
                                              const BlockRefineOptions& options);

}  // namespace agricolmap
