#include "agricolmap/pipeline/refinement.hpp"

#include <fmt/format.h>

#include "agricolmap/map/vegetation.hpp"

namespace agricolmap::pipeline {
namespace {

/// How far around the strip the fixed map's vegetation takes part [m]: its outlines decide what is
/// plant and what is soil, too.
constexpr double kVegetationRim = 2.0;

Refined failed(std::string why) {
  Refined refined;
  refined.failure = std::move(why);
  return refined;
}

/// The pose that a placement starts from; nothing when its matches determine none.
std::optional<Eigen::Affine2d> startOf(const Placement& placement,
                                       const Eigen::Matrix2d& scale_axes,
                                       const paper::AffineOptions& options) {
  if (placement.matches.empty()) return placement.pose;
  const paper::AffineEstimate fit = paper::estimateAffine(placement.matches, scale_axes, options);
  if (!fit.ok()) return std::nullopt;
  return fit.fixed_from_moving;
}

Refined refineDensely(const refine::PairSignals& signals, const std::vector<Placement>& placements,
                      const Eigen::Matrix2d& scale_axes, const RegistrationOptions& options) {
  std::vector<Eigen::Affine2d> starts;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const auto start = startOf(placements[i], scale_axes, options.affine);
    if (!start) continue;
    starts.push_back(*start);
    indices.push_back(i);
  }
  refine::RankedPoses ranked =
      refine::refineStarts(signals, starts, options.evidence.exclusion, options.dense);
  for (refine::RefinedPose& pose : ranked.distinct) pose.start = indices[pose.start];
  if (ranked.distinct.empty()) {
    return failed(
        "no placement of the moving map holds when refined: the maps have nothing coherent in "
        "common within the prior's limits");
  }
  Refined refined;
  refined.held = ranked.held;
  refined.best = refine::refineFinely(signals, ranked.distinct.front(), options.dense);
  refined.rivals.assign(ranked.distinct.begin() + 1, ranked.distinct.end());
  return refined;
}

Refined refineByPoints(const refine::PairSignals& signals, const Eigen::Affine2d& start,
                       const RegistrationOptions& options) {
  // What lies far from the strip is of no use, and on a large map costs more than all the rest.
  const map::GridMap around = signals.fixedUnder(start, kVegetationRim);
  const map::GridMap& strip = signals.moving().grid();
  const map::Vegetation fixed = map::extractVegetation(around, options.vegetation);
  const map::Vegetation moving = map::extractVegetation(strip, options.vegetation);
  for (const auto& [plants, name] : {std::pair{&fixed, "fixed"}, {&moving, "moving"}}) {
    if (plants->points.empty()) {
      return failed(fmt::format("vegetation cannot be told from soil in the {} map: {}", name,
                                toString(plants->threshold.status)));
    }
  }
  // Heights start where the maps agree on the ground; the heights' own stage has the last word.
  refine::VerticalOptions heights = options.vertical;
  heights.scale = refine::VerticalScaleKind::kAssumed;  // the paper's pose has none
  const refine::VerticalResult vertical =
      refine::fitVertical(signals.fixed().grid(), strip, start, heights);
  paper::CpdPose pose;
  pose.plane = start;
  pose.height_offset = vertical.status == refine::VerticalStatus::kOk ? vertical.offset : 0.0;
  const paper::CpdResult result =
      paper::refineByCpd(fixed.points, moving.points, pose, options.cpd);
  Refined refined;
  refined.cpd = CpdReport{fixed.points.size(), moving.points.size(),
                          static_cast<std::size_t>(result.iterations), result.matched_share};
  if (!result.usable()) {
    refined.failure = fmt::format("the point refinement failed: {}", toString(result.status));
    return refined;
  }
  refined.best = {.pose = result.pose.plane,
                  .significance = signals.score().significance(result.pose.plane)};
  return refined;
}

}  // namespace

Refined refinePlacements(const refine::PairSignals& signals,
                         const std::vector<Placement>& placements,
                         const Eigen::Matrix2d& scale_axes, const RegistrationOptions& options) {
  if (placements.empty()) {
    return failed("the data association found nothing coherent within the prior's limits");
  }
  if (options.refine == RefineKind::kDense) {
    return refineDensely(signals, placements, scale_axes, options);
  }
  for (std::size_t i = 0; i < placements.size(); ++i) {
    const auto start = startOf(placements[i], scale_axes, options.affine);
    if (!start) continue;
    Refined refined = refineByPoints(signals, *start, options);
    if (refined.best) refined.best->start = i;
    return refined;
  }
  return failed("the coherent matches of no placement determine an affine");
}

}  // namespace agricolmap::pipeline
