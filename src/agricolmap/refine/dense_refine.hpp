// Stage refine: densely, by Gauss–Newton on the signal maps themselves, coarse to fine, for a
// horizontal affine. Robust against what the two views do not share (leaves, weeds, shadows).
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/map/signal_map.hpp"
#include "agricolmap/refine/soil_pose.hpp"

namespace agricolmap::refine {

struct DenseRefineOptions {
  int iterations = 15;         ///< per level at most
  double robust = 2.0;         ///< residuals beyond this many deviations fade (Cauchy)
  double stop = 0.002;         ///< done when no corner moves by more than this share of a cell
  double prior_weight = 1e-3;  ///< pull towards the level's start, share of the data's curvature
  double max_move = 4.0;       ///< a level may move a corner by this many cells at most
  int hops = 8;      ///< rounds of looking into neighbouring basins at most, see basins.hpp
  double hop = 1.0;  ///< how far they are looked for [cells]
  SoilPoseOptions soil;
};
void listOptions(OptionTable& table, DenseRefineOptions& options);

enum class RefineStatus { kConverged, kNoOverlap, kDiverged };

struct DenseRefineResult {
  RefineStatus status = RefineStatus::kNoOverlap;
  Eigen::Affine2d fixed_from_moving = Eigen::Affine2d::Identity();  ///< meaningful if converged
  double overlap = 0.0;      ///< share of the moving map's seen cells that the fixed map sees
  double correlation = 0.0;  ///< robustly weighted, over the channels
};

/// Which of a signal map's channels take part, a bit each.
using ChannelSet = unsigned;
inline constexpr ChannelSet kAllChannels = (1U << map::kSignalChannels) - 1U;
constexpr ChannelSet channelSet(int channel) { return 1U << static_cast<unsigned>(channel); }

/// Minimises Σ_channels Σ_cells ρ((moving(x) − gain · fixed(A·x)) / σ) over a horizontal affine A,
/// from `start`. Both maps at the same cell size, levelled frames.
///
/// The gain stands at the map that is read elsewhere when A changes: so the sum falls as the
/// correlation rises. With the gain at the moving map, Σ fixed(A·x)² alone would draw the strip to
/// where the fixed map is calm, the more the less the maps have in common (ExG of drilled wheat).
DenseRefineResult refineDense(const map::SignalMap& fixed, const map::SignalMap& moving,
                              const Eigen::Affine2d& start, const DenseRefineOptions& options,
                              ChannelSet channels = kAllChannels);

/// The same from every start, side by side; results in the order of the starts.
std::vector<DenseRefineResult> refineEach(const map::SignalMap& fixed, const map::SignalMap& moving,
                                          std::span<const Eigen::Affine2d> starts,
                                          const DenseRefineOptions& options);

}  // namespace agricolmap::refine
