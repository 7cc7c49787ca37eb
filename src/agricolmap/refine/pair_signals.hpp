// The two maps of a pair as the refinement and the verdict look at them.
#pragma once

#include "agricolmap/correlation/map_signals.hpp"
#include "agricolmap/correlation/strip_score.hpp"
#include "agricolmap/map/hidden_ground.hpp"

namespace agricolmap::refine {

/// Both maps at one cell size.
struct SignalPair {
  const map::SignalMap& fixed;
  const map::SignalMap& moving;
};

/// Cells of the whole maps' levels in grid cells, coarse to fine: with the default grid 12 and 6
/// cm.
inline constexpr int kCoarseFactor = 6;
/// The one at which places are compared by their score.
inline constexpr int kRankingFactor = 3;

class PairSignals {
 public:
  /// All references must outlive this. `hidden`: how to fill in what plants hide from the moving
  /// map's camera, for the levels finer than the ranking one.
  PairSignals(const correlation::MapSignals& fixed, const correlation::MapSignals& moving,
              const map::HiddenGroundOptions& hidden,
              const correlation::MatchedFilterOptions& filter);
  PairSignals(const PairSignals&) = delete;
  PairSignals& operator=(const PairSignals&) = delete;

  /// The whole maps.
  SignalPair whole(int factor) const { return {fixed_.at(factor), moving_.at(factor)}; }
  /// The fixed map where `pose` puts the moving one and `rim` more [m].
  map::GridMap fixedUnder(const Eigen::Affine2d& pose, double rim) const;
  /// The fixed map's signals there, with room for what a refinement at this level may move.
  map::SignalMap fixedSignals(const Eigen::Affine2d& pose, int factor) const;
  /// The moving map's, with what plants hide filled in.
  const map::SignalMap& filled(int factor) const { return filled_signals_.at(factor); }
  /// Ranks poses, at kRankingFactor.
  const correlation::StripScore& score() const { return score_; }

  const correlation::MapSignals& fixed() const { return fixed_; }
  const correlation::MapSignals& moving() const { return moving_; }

 private:
  const correlation::MapSignals& fixed_;
  const correlation::MapSignals& moving_;
  map::GridMap filled_;
  correlation::MapSignals filled_signals_;
  correlation::StripScore score_;
};

}  // namespace agricolmap::refine
