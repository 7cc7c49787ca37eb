// The paper's chain with sparse features in place of the flow.
#include <utility>

#include "agricolmap/paper/vote/coherent_vote.hpp"
#include "experiments/methods/features/features.hpp"
#include "experiments/methods/peers.hpp"
#include "experiments/methods/product.hpp"

namespace agricolmap::experiments {
namespace {

/// Features and the paper's vote in place of the flow. `seeds` are keypoints of the moving map.
pipeline::Located locate(const Extract& extract, const paper::VoteOptions& vote,
                         const map::GridMap& fixed, const map::GridMap& moving,
                         const SearchSpace& space, MethodTimes& times) {
  Features fixed_features;
  Features moving_features;
  times.run("detect", [&] {
    fixed_features = extract(exgImage(fixed));
    moving_features = extract(exgImage(moving));
  });
  pipeline::Located located;
  located.matches = times.run("match", [&] {
    return matchFeatures(fixed_features, fixed.frame, moving_features, moving.frame, space, 1.0);
  });
  const std::vector<paper::VotedPlacement> voted = times.run(
      "vote", [&] { return paper::voteCoherent(located.matches, space, moving.frame.cell, vote); });
  for (const paper::VotedPlacement& one : voted) {
    Placement placement{.pose = one.pose.fixed_from_moving,
                        .score = static_cast<double>(one.inliers.size()),
                        .matches = {}};
    for (const std::uint32_t i : one.inliers) placement.matches.push_back(located.matches[i]);
    located.placements.push_back(std::move(placement));
  }
  located.flow = {
      .seeds = moving_features.size(),
      .first = {located.matches.size(), voted.empty() ? 0 : voted.front().inliers.size()},
      .again = {}};
  return located;
}

void run(const Extract& extract, const MethodInput& input, MethodOutcome& outcome) {
  pipeline::RegistrationOptions options = pipeline::preset("paper");
  options.prior = input.prior;
  Monitor monitor;
  const pipeline::Registration result = pipeline::registerClouds(
      input.fixed, input.moving, input.guess, options, monitor,
      [&](const map::GridMap& fixed, const map::GridMap& moving, const SearchSpace& space,
          Monitor&) {
        return locate(extract, options.flow.vote, fixed, moving, space, outcome.times);
      });
  outcome.times.add(monitor);
  fillFrom(result, input, outcome);
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
