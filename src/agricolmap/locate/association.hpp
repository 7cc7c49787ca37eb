// Stage 4: data association, one interface with several implementations: the paper's flow and vote
// (`flow_association.hpp`) and a global search by correlation (`correlate/`).
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/placement.hpp"
#include "agricolmap/core/search_space.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::locate {

struct AssociationResult {
  std::vector<Placement> placements;  ///< best first; empty when nothing coherent was found
  std::vector<Match> all_matches;     ///< before the vote, for pictures; may be empty
  /// Before the vote, of a second matching from what the first found; empty when there was none.
  std::vector<Match> all_rematches;
  /// Counts for the report, e.g. {"seeds", 6012}, {"matches", 3450}, {"inliers", 3001}.
  std::vector<std::pair<std::string, double>> counts;
};

class Association {
 public:
  virtual ~Association() = default;
  /// Deterministic for a given seed of its options, whatever the number of threads.
  virtual AssociationResult associate(const map::GridMap& fixed, const map::GridMap& moving,
                                      const SearchSpace& space, StageTimes& times) const = 0;
};

}  // namespace agricolmap::locate
