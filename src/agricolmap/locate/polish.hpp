// From a hypothesis on the lattice to the local maximum of the whitened score beside it.
#pragma once

#include <vector>

#include "agricolmap/correlation/matched_filter.hpp"
#include "agricolmap/locate/candidates.hpp"

namespace agricolmap::locate {

/// Climbs the whitened score of the whole moving map, which costs one look per cell: the score is
/// the sum over its cells of their values times the whitened fixed map where the pose puts them.
class Polisher {
 public:
  Polisher(const map::SignalMap& moving, const correlation::MatchedFilter& filter,
           const SearchSpace& space, const Eigen::Matrix3d& strip_metric, double min_inside);

  /// Score in the candidate's deviations, counting the cells that lie in the map; −∞ when these are
  /// less than the least share of the strip.
  double score(const Candidate& candidate) const;
  /// Compass search with halving steps over heading, scales and shift.
  Candidate improve(Candidate candidate) const;

 private:
  struct Cell {
    Eigen::Vector2f offset;  ///< from the search space's centre [m]
    float value[map::kSignalChannels];
    float energy;
  };
  std::vector<Cell> cells_;
  const correlation::MatchedFilter& filter_;
  const SearchSpace& space_;
  Eigen::Matrix3d directions_;  ///< columns: steps of (yaw, log s_x, log s_y) that move 1 m RMS
  double energy_ = 0.0;
  double min_inside_;
};

}  // namespace agricolmap::locate
