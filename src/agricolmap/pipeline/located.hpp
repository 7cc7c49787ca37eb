// Where the moving map may lie, by whatever means that was found.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/locate/correlation_search.hpp"
#include "agricolmap/paper/flow_association.hpp"
#include "agricolmap/pipeline/maps.hpp"
#include "agricolmap/refine/pair_signals.hpp"

namespace agricolmap::pipeline {

struct Located {
  std::vector<Placement> placements;  ///< best first; empty when nothing coherent was found
  std::vector<Match> matches;         ///< before a vote, where points were matched
  std::vector<Match> rematches;       ///< the same of a second matching
  std::optional<locate::SearchReport> search;  ///< of the correlation search
  std::optional<paper::FlowReport> flow;       ///< of a matching of points
  /// Significances of the best places of mirrored copies of the moving map, as of RefinedPose; none
  /// where the best placement is clear without them.
  std::vector<double> decoys;
};

/// Another way to find placements, in the chain unchanged otherwise. Must be deterministic.
using Locator = std::function<Located(const map::GridMap& fixed, const map::GridMap& moving,
                                      const SearchSpace& space, Monitor& monitor)>;

/// Where may the moving map lie? Sec. III-B, or the correlation search with the options `search`,
/// as the options say; by `locator` where it is not empty. Stage kLocate and, of the paper's way,
/// those within it.
Located locate(const PairMaps& maps, const refine::PairSignals& signals,
               const locate::RowWaves& waves, const locate::CorrelationOptions& search,
               const RegistrationOptions& options, const Locator& locator, Monitor& monitor);

}  // namespace agricolmap::pipeline
