// From a hypothesis on the lattice to the local maximum of the whitened score beside it.
#pragma once

#include <vector>

#include "agricolmap/4_associate/correlate/candidates.hpp"
#include "agricolmap/4_associate/correlate/matched_filter.hpp"

namespace agricolmap {

/// Climbs the whitened score of the whole moving map, which costs one look per cell: the score is
/// the sum over its cells of their values times the whitened fixed map where the pose puts them.
class Polisher {
 public:
  Polisher(const SignalMap& moving, const MatchedFilter& filter, const SearchSpace& space,
           const Eigen::Matrix3d& strip_metric);

  /// Score in deviations of what chance gives; comparable between all candidates of a pair, since
  /// the number of summed cells does not depend on the scales.
  double score(const Candidate& candidate) const;
  /// Compass search with halving steps over heading, scales and shift.
  Candidate improve(Candidate candidate) const;

 private:
  struct Cell {
    Eigen::Vector2f offset;  ///< from the search space's centre [m]
    float greenness, height;
  };
  std::vector<Cell> cells_;
  const MatchedFilter& filter_;
  const SearchSpace& space_;
  Eigen::Matrix3d directions_;  ///< columns: steps of (yaw, log s_x, log s_y) that move 1 m RMS
  double deviation_ = 1.0;
};

}  // namespace agricolmap
