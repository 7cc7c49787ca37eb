// From many placements to one pose: every start is refined, those that hold are compared by one
// score, and the best goes on to finer cells.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "agricolmap/refine/dense_refine.hpp"
#include "agricolmap/refine/pair_signals.hpp"

namespace agricolmap::refine {

/// A pose of the moving map, levelled moving → levelled fixed.
struct RefinedPose {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  double significance = 0.0;  ///< at the ranking level, see StripScore
  double overlap = 0.0;       ///< share of the moving map's cells with a fixed cell to compare with
  std::size_t start = 0;      ///< index of the start that it was refined from
  int factor = 0;             ///< grid cells a cell at the finest level reached; 0: not on maps
  /// Of the finest level, where it was asked.
  std::optional<SoilWitness> soil = std::nullopt;
};

struct RankedPoses {
  std::vector<RefinedPose> distinct;  ///< most significant first
  std::size_t held = 0;               ///< starts that led somewhere, to one and the same place, too
};

/// Refines the starts through the coarse levels to the ranking one, and leaves out what does not
/// hold, or ran to within `exclusion` [m] of something more significant.
RankedPoses refineStarts(const PairSignals& signals, std::span<const Eigen::Affine2d> starts,
                         double exclusion, const DenseRefineOptions& options);

/// On through the cells finer than the ranking level, there also from beside the result
/// (`basins.hpp`). What the finest cells cannot follow (a map with fewer points than cells has
/// hardly two seen side by side) stays as the coarser ones left it. Where bare soil shows clearly
/// where it lies, the result is its pose.
RefinedPose refineFinely(const PairSignals& signals, const RefinedPose& start,
                         const DenseRefineOptions& options);

/// From the ranking level on; nothing when the pose does not hold there.
std::optional<RefinedPose> refineFrom(const PairSignals& signals, const Eigen::Affine2d& pose,
                                      const DenseRefineOptions& options);

}  // namespace agricolmap::refine
