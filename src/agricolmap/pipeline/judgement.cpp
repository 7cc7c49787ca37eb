#include "agricolmap/pipeline/judgement.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "agricolmap/refine/channel_poses.hpp"
#include "agricolmap/refine/fit.hpp"
#include "agricolmap/verdict/remedies.hpp"
#include "agricolmap/verdict/sides.hpp"
#include "agricolmap/verdict/straighten.hpp"

namespace agricolmap::pipeline {
namespace {

/// Grid cells a cell at which blocks are moved alone, for the uncertainty.
constexpr int kBlockFactor = 2;
/// One block may come to agree by chance.
constexpr std::size_t kOddBlock = 1;

/// Blocks place themselves by centimetres at best: what they lay straight must also fit better.
bool fitsBetter(const Placed& next, const Placed& before) {
  return next.evidence.agreeing >= before.evidence.agreeing &&
         next.evidence.significance > before.evidence.significance &&
         next.correlation > before.correlation;
}

/// Share of the moving map's cells that the guess, which it was gridded under, lays on those of the
/// fixed map.
double guessedOverlap(const PairMaps& maps) {
  std::size_t seen = 0;
  std::size_t shared = 0;
  const GridFrame& frame = maps.moving.frame;
  const map::GridMap& fixed = maps.fixed;
  for (int row = 0; row < frame.rows; ++row) {
    for (int col = 0; col < frame.cols; ++col) {
      if (!maps.moving.valid(row, col)) continue;
      ++seen;
      const Eigen::Vector2d at = fixed.frame.cellOf(frame.centre(row, col)).array().round();
      const bool inside =
          at.x() >= 0.0 && at.x() < fixed.frame.cols && at.y() >= 0.0 && at.y() < fixed.frame.rows;
      if (!inside) continue;
      shared += fixed.valid(static_cast<int>(at.y()), static_cast<int>(at.x())) ? 1 : 0;
    }
  }
  return seen == 0 ? 0.0 : static_cast<double>(shared) / static_cast<double>(seen);
}

Measured measureBent(const refine::PairSignals& signals, const SearchSpace& space,
                     const Refined& refined, const RegistrationOptions& options, Monitor& monitor) {
  const auto at = [&](const refine::RefinedPose& found) {
    return measure(signals, space, found, refined, options, monitor);
  };
  Measured measured{at(*refined.best), {}};
  // The paper's own refinement stays as it is.
  if (options.refine != RefineKind::kDense || !options.straighten) return measured;
  const auto straight = verdict::straightenedPose(measured.placed.evidence, space.scale_axes);
  if (!straight) return measured;
  Placed laid = at({.pose = *straight});
  measured.straightened = false;
  if (laid.evidence.agreeing <= measured.placed.evidence.agreeing + kOddBlock) return measured;
  const auto take = [&](Placed next) {
    if (!fitsBetter(next, measured.placed)) return;
    measured.placed = std::move(next);
    measured.straightened = true;
  };
  take(std::move(laid));
  // It may not have been bent, but caught at the edge of the refinement's basin.
  const auto finer = monitor.run(
      Stage::kRefine, [&] { return refine::refineFrom(signals, *straight, options.dense); });
  if (finer) take(at(*finer));
  return measured;
}

}  // namespace

Placed measure(const refine::PairSignals& signals, const SearchSpace& space,
               const refine::RefinedPose& found, const Refined& refined,
               const RegistrationOptions& options, Monitor& monitor) {
  const Eigen::Affine2d& pose = found.pose;
  Placed placed;
  placed.pose = pose;
  placed.placement = refined.best->start;
  placed.refined_cell = found.factor * signals.moving().grid().frame.cell;
  placed.heights = monitor.run(Stage::kHeights, [&] {
    return refine::fitVertical(signals.fixed().grid(), signals.moving().grid(), pose,
                               options.vertical);
  });
  placed.heights_verdict = verdict::judgeHeights(placed.heights, options.uncertainty);
  monitor.run(Stage::kJudge, [&] {
    // At the ranking level: finer maps may be sparser than their cells.
    const refine::SignalPair whole = signals.whole(refine::kRankingFactor);
    const refine::Fit fit = refine::fitOf(whole.fixed, whole.moving, pose);
    placed.correlation = fit.correlation;
    placed.overlap = fit.overlap;
    const double rival = refined.rivals.empty() ? 0.0 : refined.rivals.front().significance;
    placed.evidence =
        verdict::measureEvidence(signals.score(), pose, space, rival, options.evidence);
    placed.evidence.decoys = refined.decoys;
    const map::SignalMap fixed = signals.fixedSignals(pose, kBlockFactor);
    const map::SignalMap& moving = signals.filled(kBlockFactor);
    const double systematic = std::hypot(
        refine::disagreementOfChannels(fixed, moving, pose, denseInForce(options)).value_or(0.0),
        options.uncertainty.lean * map::canopyHeight(signals.moving().grid()));
    placed.uncertainty =
        verdict::estimateUncertainty(fixed, moving, pose, placed.evidence, space, systematic,
                                     placed.heights_verdict.deviation, options.uncertainty);
  });
  return placed;
}

Measured measureStraightened(const refine::PairSignals& signals, const SearchSpace& space,
                             const Refined& refined, const RegistrationOptions& options,
                             Monitor& monitor) {
  Measured measured = measureBent(signals, space, refined, options, monitor);
  const verdict::PartsReport& parts = measured.placed.evidence.parts;
  if (!parts.larger || options.refine != RefineKind::kDense) return measured;
  // A compromise between two parts lays neither: the larger one's pose does, and names the other.
  Placed laid = measure(signals, space, {.pose = *parts.larger}, refined, options, monitor);
  if (laid.evidence.parts.displaced.size() <= parts.displaced.size()) {
    measured.placed = std::move(laid);
  }
  return measured;
}

verdict::Verdict judgePlaced(const Placed& placed, const std::vector<refine::RefinedPose>& rivals,
                             const PairMaps& maps, const RegistrationOptions& options) {
  const SearchSpace& space = maps.space;
  if (placed.heights.status != refine::VerticalStatus::kOk) {
    return verdict::rejectBecause("the heights of the two maps do not fit one another");
  }
  verdict::Finding finding{
      .evidence = placed.evidence,
      .uncertainty = placed.uncertainty,
      .heights = placed.heights_verdict,
      .overlap = placed.overlap,
      .pose = placed.followed ? placed.pose * placed.followed->longest : placed.pose,
      .guessed_overlap = space.uncertainty.anywhere() ? 1.0 : guessedOverlap(maps),
      .rivals = {},
      .slip_rms = placed.followed ? deform::slipRms(placed.followed->bend.deformation) : 0.0};
  for (const refine::RefinedPose& rival : rivals) finding.rivals.push_back(rival.significance);
  verdict::Verdict verdict = verdict::judge(finding, space, options.verdict);
  verdict.remedies = verdict::remediesFor(verdict, finding, space, options.verdict);
  if (placed.followed) verdict.reasons.push_back(describe(placed.followed->bend));
  if (placed.heights.scale != 1.0) {
    verdict.reasons.push_back(fmt::format(
        "the ground rises and falls {:.2f} times as much in the fixed map, which the transform's "
        "vertical scale follows",
        placed.heights.scale));
  }
  // Looked at in long strips alone: what the sides of a short one differ by may be its plants.
  const bool is_long = 2.0 * placed.evidence.strip.half_extent.x() > options.search.max_length;
  if (const auto apart = verdict::sidesApart(placed.evidence); apart && is_long) {
    verdict.reasons.push_back(fmt::format(
        "the strip's two sides lie {:.0f} cm apart: if the robot passed twice, give its path",
        100.0 * *apart));
  }
  if (options.association != AssociationKind::kCorrelation ||
      options.refine != RefineKind::kDense) {
    verdict.reasons.emplace_back(
        "the probability is calibrated for the default chain, not for this");
  }
  return verdict;
}

}  // namespace agricolmap::pipeline
