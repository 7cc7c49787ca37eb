// The paper's chain with sparse features in place of the flow (Sec. V-B): detection, description
// and matching on the Excess Green map; vote, affine and CPD unchanged.
#pragma once

#include <memory>
#include <string>

#include "agricolmap/paper/vote/coherent_vote.hpp"
#include "experiments/methods/features/features.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// Features and the paper's vote as a data association. Counts as of the flow: `seeds` (keypoints
/// of the moving map), `matches`, `inliers`, `inlier_share`; stages `detect`, `match`, `vote`.
class FeatureAssociation : public locate::Association {
 public:
  explicit FeatureAssociation(const FeatureExtractor& extractor, const MatchOptions& matching = {},
                              const paper::VoteOptions& vote = {})
      : extractor_(extractor), matching_(matching), vote_(vote) {}
  locate::AssociationResult associate(const map::GridMap& fixed, const map::GridMap& moving,
                                      const SearchSpace& space, StageTimes& times) const override;

 private:
  const FeatureExtractor& extractor_;
  MatchOptions matching_;
  paper::VoteOptions vote_;
};

/// A method with the extractor's name.
std::unique_ptr<Method> makeFeatureChain(std::unique_ptr<FeatureExtractor> extractor,
                                         const std::string& about);

}  // namespace agricolmap::experiments
