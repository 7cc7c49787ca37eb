#include "experiments/methods/sift_affine.hpp"

#include <fmt/format.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "experiments/methods/peer_maps.hpp"

namespace agricolmap::experiments {
namespace {

/// An affine and how many matches agree with it.
struct RobustFit {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  std::size_t inliers = 0;
};

/// By USAC; about the middle of the matches, in cells, so that floats lose nothing.
std::optional<RobustFit> fitRobustly(const std::vector<Match>& matches, double cell,
                                     const SiftAffineOptions& options) {
  if (matches.size() < 3) return std::nullopt;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  for (const Match& match : matches) {
    from += match.moving / static_cast<double>(matches.size());
    to += match.fixed / static_cast<double>(matches.size());
  }
  std::vector<cv::Point2d> sources;
  std::vector<cv::Point2d> targets;
  for (const Match& match : matches) {
    const Eigen::Vector2d p = (match.moving - from) / cell;
    const Eigen::Vector2d q = (match.fixed - to) / cell;
    sources.emplace_back(p.x(), p.y());
    targets.emplace_back(q.x(), q.y());
  }
  cv::Mat inliers;
  const cv::Mat fit =
      cv::estimateAffine2D(sources, targets, inliers, cv::USAC_MAGSAC, options.threshold,
                           static_cast<std::size_t>(options.iterations), options.confidence);
  if (fit.empty()) return std::nullopt;
  RobustFit result;
  for (int r = 0; r < 2; ++r) {
    for (int c = 0; c < 2; ++c) result.pose.linear()(r, c) = fit.at<double>(r, c);
    result.pose.translation()[r] = cell * fit.at<double>(r, 2);
  }
  result.pose = Eigen::Translation2d(to) * result.pose * Eigen::Translation2d(-from);
  result.inliers = static_cast<std::size_t>(cv::countNonZero(inliers));
  return result;
}

class SiftAffine : public Method {
 public:
  explicit SiftAffine(const SiftAffineOptions& options)
      : options_(options), extractor_(makeSift(options.sift)) {}
  std::string name() const override { return "sift-affine"; }
  std::string about() const override { return "SIFT and an affine by USAC with MAGSAC++"; }

  Traits traits() const override { return {.matches_points = true}; }

 protected:
  void attempt(const MethodInput& input, MethodOutcome& outcome) const override {
    const PeerMaps maps = makePeerMaps(input, outcome.times);
    Features fixed;
    Features moving;
    outcome.times.run("detect", [&] {
      fixed = extractor_->extract(exgImage(maps.fixed));
      moving = extractor_->extract(exgImage(maps.moving));
    });
    const std::vector<Match> matches = outcome.times.run("match", [&] {
      return matchFeatures(fixed, maps.fixed.frame, moving, maps.moving.frame, maps.space,
                           {.ratio = options_.ratio});
    });
    const std::optional<RobustFit> fit = outcome.times.run(
        "affine", [&] { return fitRobustly(matches, maps.moving.frame.cell, options_); });
    addMatches("matches", maps.frames, input, matches, static_cast<double>(fit ? fit->inliers : 0),
               outcome);
    if (!fit || !(fit->pose.linear().determinant() > 0.0)) {
      outcome.why = fmt::format("{} matches determine no affine", matches.size());
      return;
    }
    outcome.accepted = fit->inliers >= static_cast<std::size_t>(options_.least);
    if (!outcome.accepted) {
      outcome.why = fmt::format("only {} of {} matches agree", fit->inliers, matches.size());
    }
    setPlanePose(maps, input, fit->pose, outcome);
  }

 private:
  SiftAffineOptions options_;
  std::unique_ptr<FeatureExtractor> extractor_;
};

}  // namespace

std::unique_ptr<Method> makeSiftAffine(const SiftAffineOptions& options) {
  return std::make_unique<SiftAffine>(options);
}

}  // namespace agricolmap::experiments
