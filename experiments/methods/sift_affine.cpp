// SIFT and a robust affine: what OpenCV offers for laying one picture of the ground on another.
#include <fmt/format.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <optional>
#include <utility>

#include "experiments/methods/features/features.hpp"
#include "experiments/methods/peer_maps.hpp"
#include "experiments/methods/peers.hpp"

namespace agricolmap::experiments {
namespace {

constexpr double kRatio = 0.9;      // Lowe: 0.8, which leaves too few where all plants are alike
constexpr double kThreshold = 3.0;  // of an inlier [cells]; library default
constexpr std::size_t kIterations = 100000;  // at most; few of the matches are right (our choice)
constexpr double kConfidence = 0.999;        // library examples
constexpr std::size_t kLeast = 10;           // inliers to stand by the result; library's tutorial

/// An affine and how many matches agree with it.
struct RobustFit {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  std::size_t inliers = 0;
};

/// By USAC; about the middle of the matches, in cells, so that floats lose nothing.
std::optional<RobustFit> fitRobustly(const std::vector<Match>& matches, double cell) {
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
  const cv::Mat fit = cv::estimateAffine2D(sources, targets, inliers, cv::USAC_MAGSAC, kThreshold,
                                           kIterations, kConfidence);
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

}  // namespace

void siftAffine(const MethodInput& input, MethodOutcome& outcome) {
  const PeerMaps maps = makePeerMaps(input, outcome.times);
  Features fixed;
  Features moving;
  outcome.times.run("detect", [&] {
    fixed = siftFeatures(exgImage(maps.fixed));
    moving = siftFeatures(exgImage(maps.moving));
  });
  const std::vector<Match> matches = outcome.times.run("match", [&] {
    return matchFeatures(fixed, maps.fixed.frame, moving, maps.moving.frame, maps.space, kRatio);
  });
  const std::optional<RobustFit> fit =
      outcome.times.run("affine", [&] { return fitRobustly(matches, maps.moving.frame.cell); });
  addMatches("matches", maps.frames, input, matches, static_cast<double>(fit ? fit->inliers : 0),
             outcome);
  if (!fit || !(fit->pose.linear().determinant() > 0.0)) {
    outcome.why = fmt::format("{} matches determine no affine", matches.size());
    return;
  }
  outcome.accepted = fit->inliers >= kLeast;
  if (!outcome.accepted) {
    outcome.why = fmt::format("only {} of {} matches agree", fit->inliers, matches.size());
  }
  setPlanePose(maps, input, fit->pose, outcome);
}

}  // namespace agricolmap::experiments
