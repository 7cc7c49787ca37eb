// The paper's chain with sparse features in place of the flow.
#include <utility>

#include "agricolmap/paper/vote/coherent_vote.hpp"
#include "experiments/methods/features/features.hpp"
#include "experiments/methods/peers.hpp"
#include "experiments/methods/product.hpp"

namespace agricolmap::experiments {
namespace {

/// Features and the paper's vote as a data association. Counts as of the flow: `seeds` (keypoints
/// of the moving map), `matches`, `inliers`, `inlier_share`; stages `detect`, `match`, `vote`.
class FeatureAssociation : public locate::Association {
 public:
  FeatureAssociation(Extract extract, const paper::VoteOptions& vote)
      : extract_(extract), vote_(vote) {}

  locate::AssociationResult associate(const map::GridMap& fixed, const map::GridMap& moving,
                                      const SearchSpace& space, StageTimes& times) const override {
    Features fixed_features;
    Features moving_features;
    times.run("detect", [&] {
      fixed_features = extract_(exgImage(fixed));
      moving_features = extract_(exgImage(moving));
    });
    locate::AssociationResult result;
    result.all_matches = times.run("match", [&] {
      return matchFeatures(fixed_features, fixed.frame, moving_features, moving.frame, space, 1.0);
    });
    const std::vector<paper::VotedPlacement> voted = times.run("vote", [&] {
      return paper::voteCoherent(result.all_matches, space, moving.frame.cell, vote_);
    });
    for (const paper::VotedPlacement& one : voted) {
      Placement placement;
      placement.score = static_cast<double>(one.inliers.size());
      for (const std::uint32_t i : one.inliers) placement.matches.push_back(result.all_matches[i]);
      result.placements.push_back(std::move(placement));
    }
    const auto matches = static_cast<double>(result.all_matches.size());
    const double inliers = voted.empty() ? 0.0 : static_cast<double>(voted.front().inliers.size());
    result.counts = {{"seeds", static_cast<double>(moving_features.size())},
                     {"matches", matches},
                     {"inliers", inliers},
                     {"inlier_share", matches > 0.0 ? inliers / matches : 0.0}};
    return result;
  }

 private:
  Extract extract_;
  paper::VoteOptions vote_;
};

void run(Extract extract, const MethodInput& input, MethodOutcome& outcome) {
  pipeline::RegistrationOptions options = pipeline::preset("paper");
  options.prior = input.prior;
  const FeatureAssociation association(extract, options.flow.vote);
  const pipeline::Registration result = pipeline::registerClouds(
      input.fixed, input.moving, input.guess, options, outcome.times, &association);
  fillFrom(result, input, true, outcome);
}

}  // namespace

void surfChain(const MethodInput& input, MethodOutcome& outcome) {
  run(surfFeatures, input, outcome);
}

void orbChain(const MethodInput& input, MethodOutcome& outcome) {
  run(orbFeatures, input, outcome);
}

void fastBriefChain(const MethodInput& input, MethodOutcome& outcome) {
  run(fastBriefFeatures, input, outcome);
}

}  // namespace agricolmap::experiments
