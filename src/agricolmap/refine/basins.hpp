// Stage refine, too: Gauss–Newton ends in the basin it starts in. Where plants stand as close as
// the coarser cells are wide, as in drilled wheat, that was the neighbouring one for three of six
// simulated strips: 2 to 5 cm off, or sheared, with all blocks in agreement.
#pragma once

#include "agricolmap/refine/dense_refine.hpp"

namespace agricolmap::refine {

/// Refines from `start`, then from that result moved, turned, stretched and sheared a little
/// (options.hop, both ways each), and goes on from the best of them, options.hops times at most, as
/// long as the correlation grows. The result has the highest correlation found; its status is that
/// of the refinement from `start` when nothing better was found.
DenseRefineResult refineAcrossBasins(const map::SignalMap& fixed, const map::SignalMap& moving,
                                     const Eigen::Affine2d& start,
                                     const DenseRefineOptions& options);

}  // namespace agricolmap::refine
