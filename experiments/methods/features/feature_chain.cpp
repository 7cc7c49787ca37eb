#include "experiments/methods/features/feature_chain.hpp"

#include <utility>

#include "experiments/methods/product.hpp"

namespace agricolmap::experiments {
namespace {

class FeatureChain : public Method {
 public:
  FeatureChain(std::unique_ptr<FeatureExtractor> extractor, std::string about)
      : extractor_(std::move(extractor)), about_(std::move(about)) {}
  std::string name() const override { return extractor_->name(); }
  std::string about() const override { return about_; }
  Traits traits() const override { return {.matches_points = true}; }

 protected:
  void attempt(const MethodInput& input, MethodOutcome& outcome) const override {
    pipeline::RegistrationOptions options = pipeline::preset("paper");
    options.prior = input.prior;
    const FeatureAssociation association(*extractor_, {}, options.flow.vote);
    const pipeline::Registration result = pipeline::registerClouds(
        input.fixed, input.moving, input.guess, options, outcome.times, &association);
    fillFrom(result, input, true, outcome);
  }

 private:
  std::unique_ptr<FeatureExtractor> extractor_;
  std::string about_;
};

}  // namespace

locate::AssociationResult FeatureAssociation::associate(const map::GridMap& fixed,
                                                        const map::GridMap& moving,
                                                        const SearchSpace& space,
                                                        StageTimes& times) const {
  Features fixed_features;
  Features moving_features;
  times.run("detect", [&] {
    fixed_features = extractor_.extract(exgImage(fixed));
    moving_features = extractor_.extract(exgImage(moving));
  });
  locate::AssociationResult result;
  result.all_matches = times.run("match", [&] {
    return matchFeatures(fixed_features, fixed.frame, moving_features, moving.frame, space,
                         matching_);
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

std::unique_ptr<Method> makeFeatureChain(std::unique_ptr<FeatureExtractor> extractor,
                                         const std::string& about) {
  return std::make_unique<FeatureChain>(std::move(extractor), about);
}

}  // namespace agricolmap::experiments
