// Where the moving map may lie, by whatever means that was found.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/locate/correlation_search.hpp"
#include "agricolmap/paper/flow_association.hpp"

namespace agricolmap::pipeline {

struct Located {
  std::vector<Placement> placements;  ///< best first; empty when nothing coherent was found
  std::vector<Match> matches;         ///< before a vote, where points were matched
  std::vector<Match> rematches;       ///< the same of a second matching
  std::optional<locate::SearchReport> search;  ///< of the correlation search
  std::optional<paper::FlowReport> flow;       ///< of a matching of points
};

/// Another way to find placements, in the chain unchanged otherwise. Must be deterministic.
using Locator = std::function<Located(const map::GridMap& fixed, const map::GridMap& moving,
                                      const SearchSpace& space, Monitor& monitor)>;

}  // namespace agricolmap::pipeline
