// The paper's data association (Sec. III): dense flow between grid maps and a vote for its coherent
// part.
#pragma once

#include "agricolmap/3_describe/descriptor_map.hpp"
#include "agricolmap/4_associate/association.hpp"
#include "agricolmap/4_associate/flow/patch_match.hpp"
#include "agricolmap/4_associate/vote/coherent_vote.hpp"

namespace agricolmap {

struct FlowAssociationOptions {
  DescribeOptions describe;  ///< data term and descriptors
  CostOptions cost;          ///< α and β
  FlowOptions flow;
  VoteOptions vote;
  int seed = 1;  ///< of the random search
};
void describe(OptionTable& table, FlowAssociationOptions& options);

/// Fills the counts `seeds`, `matches` (confirmed by the backward flow), `inliers` of the best
/// placement and `inlier_share` = inliers / matches, and runs the stages `describe`, `flow`,
/// `vote`.
class FlowAssociation : public Association {
 public:
  /// Throws UsageError for options outside their limits.
  explicit FlowAssociation(const FlowAssociationOptions& options);
  AssociationResult associate(const GridMap& fixed, const GridMap& moving, const SearchSpace& space,
                              StageTimes& times) const override;

 private:
  FlowAssociationOptions options_;
};

}  // namespace agricolmap
