// The paper's data association (Sec. III): dense flow between grid maps and a vote for its coherent
// part.
#pragma once

#include <optional>
#include <vector>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/core/placement.hpp"
#include "agricolmap/paper/describe/descriptor_map.hpp"
#include "agricolmap/paper/flow/patch_match.hpp"
#include "agricolmap/paper/vote/coherent_vote.hpp"

namespace agricolmap::paper {

struct FlowAssociationOptions {
  DescribeOptions describe;  ///< data term and descriptors
  CostOptions cost;          ///< α and β
  FlowOptions flow;
  VoteOptions vote;
  /// Matches with the moving map warped beforehand where the guess may be off by more than the
  /// descriptors tolerate; not in the paper.
  bool warps = true;
  double heading_tolerance_deg = 8.0;  ///< heading error to match with without a warp [°]
  double scale_tolerance = 0.18;       ///< and error of a scale's logarithm
  /// Matches the placements found again, each with the moving map warped by it; not in the
  /// paper.
  bool rematch = true;
  int seed = 1;  ///< of the random search; not listed: the registration has one
};
void listOptions(OptionTable& table, FlowAssociationOptions& options);

/// Matches, and those of them that cohere.
struct MatchCount {
  std::size_t matches = 0;  ///< confirmed by the backward flow
  std::size_t inliers = 0;  ///< of the best placement
  double share() const {
    return matches == 0 ? 0.0 : static_cast<double>(inliers) / static_cast<double>(matches);
  }
};

/// What a flow and its vote were, for the report.
struct FlowReport {
  std::size_t seeds = 0;
  MatchCount first;
  std::optional<MatchCount> again;  ///< of the second matching, where there was one
};

struct FlowResult {
  std::vector<Placement> placements;  ///< best first; empty when nothing coherent was found
  std::vector<Match> matches;         ///< before the vote
  std::vector<Match> rematches;       ///< the same of the second matching; empty without one
  FlowReport report;
};

/// Descriptors are only so tolerant of turning and stretching. With `warps`, what the guess allows
/// is cut into parts within the tolerances, and the moving map is matched once per part, warped to
/// its middle. With `rematch`, what was found is confirmed with the moving map laid as found: right
/// placements then match nearly everywhere and wrong ones do not, so the scores tell more. A score
/// is the number of inliers, with warps that stretch the map counted as if they did not. With both
/// off this is the paper's method.
///
/// Deterministic for a given seed, whatever the number of threads. Runs the stages kDescribe, kFlow
/// and kVote.
FlowResult associateByFlow(const map::GridMap& fixed, const map::GridMap& moving,
                           const SearchSpace& space, const FlowAssociationOptions& options,
                           Monitor& monitor);

}  // namespace agricolmap::paper
