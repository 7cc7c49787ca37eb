#include "agricolmap/refine/multi_start.hpp"

#include <algorithm>
#include <array>

#include "agricolmap/core/keep_distinct.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/refine/basins.hpp"

namespace agricolmap::refine {
namespace {

/// Grid cells a cell, for the best placement alone: 6 cm again, 4 and 2 cm, with what plants hide
/// filled in.
constexpr std::array<int, 3> kFineFactors = {3, 2, 1};
/// The finest level whose result is compared with what lies beside it: neighbouring basins of finer
/// ones are nearer than plants are.
constexpr int kBasinFactor = 2;
/// Finer cells must have at least this share of the coarser ones' overlap.
constexpr double kLeastFinerOverlap = 0.5;
/// Of the fixed map around what is compared of the soil [m].
constexpr double kSoilRim = 0.5;

/// One level for all poses; those that do not hold are left out.
std::vector<RefinedPose> refineLevel(const PairSignals& signals, int factor,
                                     const std::vector<RefinedPose>& poses,
                                     const DenseRefineOptions& options) {
  const SignalPair level = signals.whole(factor);
  std::vector<Eigen::Affine2d> starts;
  starts.reserve(poses.size());
  for (const RefinedPose& pose : poses) starts.push_back(pose.pose);
  const std::vector<DenseRefineResult> refined =
      refineEach(level.fixed, level.moving, starts, options);
  std::vector<RefinedPose> held;
  for (std::size_t i = 0; i < refined.size(); ++i) {
    if (refined[i].status != RefineStatus::kConverged) continue;
    held.push_back({refined[i].fixed_from_moving, poses[i].significance, refined[i].overlap,
                    poses[i].start, factor});
  }
  return held;
}

/// From what the plants say to what plants and soil say together.
void followSoil(const PairSignals& signals, const SoilPoseOptions& options, RefinedPose& best) {
  const map::SignalTerm term = signals.moving().options().term;
  const bool bright = term == map::SignalTerm::kAll || term == map::SignalTerm::kRgb;
  if (!options.follow || !bright || best.factor == 0) return;
  const double rim = options.reach + 2.0 * options.wave + kSoilRim;
  best.soil = askSoil(signals.fixedUnder(best.pose, rim), signals.moving().grid(), best.pose,
                      best.factor, options);
  best.pose = heardTogether(best.pose, *best.soil);
}

}  // namespace

RankedPoses refineStarts(const PairSignals& signals, std::span<const Eigen::Affine2d> starts,
                         double exclusion, const DenseRefineOptions& options) {
  std::vector<RefinedPose> poses;
  for (std::size_t i = 0; i < starts.size(); ++i) poses.push_back({starts[i], 0.0, 0.0, i, 0});
  for (const int factor : {kCoarseFactor, kRankingFactor}) {
    poses = refineLevel(signals, factor, poses, options);
  }
  const correlation::StripScore& score = signals.score();
  parallelFor(poses.size(),
              [&](std::size_t i) { poses[i].significance = score.significance(poses[i].pose); });
  std::stable_sort(poses.begin(), poses.end(), [](const RefinedPose& a, const RefinedPose& b) {
    return a.significance > b.significance;
  });
  RankedPoses ranked;
  ranked.held = poses.size();
  ranked.distinct =
      keepDistinct(std::move(poses), [&](const RefinedPose& better, const RefinedPose& one) {
        return score.distance(one.pose, better.pose) <= exclusion;
      });
  return ranked;
}

RefinedPose refineFinely(const PairSignals& signals, const RefinedPose& start,
                         const DenseRefineOptions& options) {
  RefinedPose best = start;
  for (const int factor : kFineFactors) {
    const map::SignalMap fixed = signals.fixedSignals(best.pose, factor);
    const map::SignalMap& moving = signals.filled(factor);
    const DenseRefineResult finer = factor >= kBasinFactor
                                        ? refineAcrossBasins(fixed, moving, best.pose, options)
                                        : refineDense(fixed, moving, best.pose, options);
    if (finer.status != RefineStatus::kConverged ||
        finer.overlap < kLeastFinerOverlap * best.overlap) {
      break;
    }
    best.pose = finer.fixed_from_moving;
    best.overlap = finer.overlap;
    best.factor = factor;
  }
  followSoil(signals, options.soil, best);
  return best;
}

std::optional<RefinedPose> refineFrom(const PairSignals& signals, const Eigen::Affine2d& pose,
                                      const DenseRefineOptions& options) {
  const std::vector<RefinedPose> ranked = refineLevel(signals, kRankingFactor, {{pose}}, options);
  if (ranked.empty()) return std::nullopt;
  return refineFinely(signals, ranked.front(), options);
}

}  // namespace agricolmap::refine
