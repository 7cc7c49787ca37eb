#include "agricolmap/pipeline/refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/refine/basins.hpp"

namespace agricolmap::pipeline {
namespace {

// Cells of a level in grid cells. With the default grid: 12 and 6 cm, at which all placements are
// refined over the whole maps and ranked at the second; 6 cm again, 4 and 2 cm for the best, with
// what plants hide filled in.
constexpr std::array<int, 2> kFactors = {6, 3};
constexpr std::size_t kRankingLevel = 1;
constexpr std::array<int, 3> kFinerFactors = {3, 2, 1};
/// The finest level whose result is compared with what lies beside it: neighbouring basins of finer
/// ones are nearer than plants are.
constexpr int kBasinFactor = 2;
/// At which blocks are moved alone, for the uncertainty.
constexpr int kBlockFactor = 2;
/// Finer cells must have at least this share of the coarser ones' overlap.
constexpr double kLeastFinerOverlap = 0.5;
/// How far around the strip the fixed map's vegetation takes part [m]: its outlines decide what is
/// plant and what is soil, too.
constexpr double kVegetationRim = 2.0;

map::GridMap withoutHidden(const map::GridMap& moving, const RegistrationOptions& options) {
  map::HiddenGroundOptions hidden = options.hidden;
  // The RGB term reads colours, which the hidden ground is not given.
  if (options.signal.term == map::DataTerm::kRgb) hidden.fill = false;
  return map::withHiddenGround(moving, hidden);
}

RefineOutcome failed(std::string why) {
  RefineOutcome outcome;
  outcome.failure = std::move(why);
  return outcome;
}

}  // namespace

PoseRefinement::PoseRefinement(const map::GridMap& fixed, const map::GridMap& moving,
                               const SearchSpace& space, const RegistrationOptions& options)
    : fixed_(fixed),
      moving_(moving),
      filled_(withoutHidden(moving, options)),
      space_(space),
      options_(options) {
  for (const int factor : kFactors) {
    levels_.push_back({map::makeSignalMap(fixed, factor, options.signal),
                       map::makeSignalMap(moving, factor, options.signal)});
  }
  meter_ = std::make_unique<verdict::EvidenceMeter>(
      levels_[kRankingLevel].fixed, levels_[kRankingLevel].moving, options.evidence);
}

std::optional<RefinedPose> PoseRefinement::refineAt(const Level& level, const RefinedPose& start,
                                                    bool across_basins) const {
  const auto refine = across_basins ? refine::refineAcrossBasins : refine::refineDense;
  const refine::DenseRefineResult dense =
      refine(level.fixed, level.moving, start.pose, options_.dense);
  if (dense.status != refine::RefineStatus::kConverged) return std::nullopt;
  return RefinedPose{dense.fixed_from_moving, start.significance, dense.overlap};
}

map::GridMap PoseRefinement::fixedUnder(const Eigen::Affine2d& pose, double rim) const {
  const GridFrame& frame = moving_.frame;
  map::Box2 window;
  for (const double row : {-0.5, frame.rows - 0.5}) {
    for (const double col : {-0.5, frame.cols - 0.5}) window.extend(pose * frame.centre(row, col));
  }
  window.extend((window.min() - Eigen::Vector2d::Constant(rim)).eval());
  window.extend((window.max() + Eigen::Vector2d::Constant(rim)).eval());
  return map::croppedMap(fixed_, window);
}

PoseRefinement::Level PoseRefinement::levelUnder(const Eigen::Affine2d& pose, int factor) const {
  // Room for the high-pass, and for what a level may move the pose by.
  const double rim = 1.5 * options_.signal.high_pass + 8.0 * factor * moving_.frame.cell;
  return {map::makeSignalMap(fixedUnder(pose, rim), factor, options_.signal),
          map::makeSignalMap(filled_, factor, options_.signal)};
}

RefineOutcome PoseRefinement::rank(const std::vector<std::optional<RefinedPose>>& poses) const {
  std::vector<RefinedPose> order;
  for (const auto& pose : poses) {
    if (pose) order.push_back(*pose);
  }
  std::stable_sort(order.begin(), order.end(), [](const RefinedPose& a, const RefinedPose& b) {
    return a.significance > b.significance;
  });
  RefineOutcome outcome;
  std::vector<RefinedPose> distinct;
  for (const RefinedPose& pose : order) {
    // Placements that ran to one and the same place are no rivals.
    const bool is_new =
        std::none_of(distinct.begin(), distinct.end(), [&](const RefinedPose& other) {
          return meter_->distance(pose.pose, other.pose) <= options_.evidence.exclusion;
        });
    if (is_new) distinct.push_back(pose);
  }
  if (distinct.empty()) return outcome;
  outcome.best = distinct.front();
  outcome.rivals.assign(distinct.begin() + 1, distinct.end());
  return outcome;
}

RefinedPose PoseRefinement::refineFinely(const RefinedPose& start) const {
  RefinedPose best = start;
  // What the finest cells cannot follow (a map with fewer points than cells has hardly two seen
  // side by side) stays as the coarser ones left it; whether it is right is for the verdict to say.
  for (const int factor : kFinerFactors) {
    const std::optional<RefinedPose> finer =
        refineAt(levelUnder(best.pose, factor), best, factor >= kBasinFactor);
    if (!finer || finer->overlap < kLeastFinerOverlap * best.overlap) break;
    best = *finer;
  }
  return best;
}

std::optional<RefinedPose> PoseRefinement::refineFrom(const Eigen::Affine2d& pose) const {
  const std::optional<RefinedPose> ranked = refineAt(levels_[kRankingLevel], RefinedPose{pose});
  return ranked ? std::optional(refineFinely(*ranked)) : std::nullopt;
}

RefineOutcome PoseRefinement::refineDensely(
    std::vector<std::optional<RefinedPose>> poses,
    std::vector<std::pair<std::string, double>>& counts) const {
  parallelFor(poses.size(), [&](std::size_t i) {
    for (std::size_t level = 0; level <= kRankingLevel && poses[i]; ++level) {
      poses[i] = refineAt(levels_[level], *poses[i]);
    }
    if (poses[i]) poses[i]->significance = meter_->significance(poses[i]->pose);
  });
  RefineOutcome outcome = rank(poses);
  counts.emplace_back("refined_placements", static_cast<double>(std::count_if(
                                                poses.begin(), poses.end(),
                                                [](const auto& p) { return p.has_value(); })));
  if (outcome.best) outcome.best = refineFinely(*outcome.best);
  if (!outcome.best) {
    outcome.failure =
        "no placement of the moving map holds when refined: the maps have nothing coherent in "
        "common within the prior's limits";
  }
  return outcome;
}

RefineOutcome PoseRefinement::refineByPoints(
    const RefinedPose& start, std::vector<std::pair<std::string, double>>& counts) const {
  // What lies far from the strip is of no use, and on a large map costs more than all the rest.
  const map::GridMap around = fixedUnder(start.pose, kVegetationRim);
  const map::Vegetation fixed = map::extractVegetation(around, options_.vegetation);
  const map::Vegetation moving = map::extractVegetation(moving_, options_.vegetation);
  for (const auto& [map, name] : {std::pair{&fixed, "fixed"}, {&moving, "moving"}}) {
    if (map->points.empty()) {
      return failed(fmt::format("vegetation cannot be told from soil in the {} map: {}", name,
                                toString(map->threshold.status)));
    }
  }
  // Heights start where the maps agree on the ground; the vertical stage has the last word.
  const refine::VerticalResult vertical =
      refine::fitVertical(fixed_, moving_, start.pose, options_.vertical);
  paper::CpdPose pose;
  pose.plane = start.pose;
  pose.height_offset = vertical.status == refine::VerticalStatus::kOk ? vertical.offset : 0.0;
  const paper::CpdResult result =
      paper::refineByCpd(fixed.points, moving.points, pose, options_.cpd);
  counts.emplace_back("fixed_vegetation_points", static_cast<double>(fixed.points.size()));
  counts.emplace_back("moving_vegetation_points", static_cast<double>(moving.points.size()));
  counts.emplace_back("cpd_iterations", static_cast<double>(result.iterations));
  counts.emplace_back("cpd_matched_share", result.matched_share);
  if (!result.usable()) {
    return failed(fmt::format("the point refinement failed: {}", toString(result.status)));
  }
  RefineOutcome outcome;
  outcome.best =
      RefinedPose{result.pose.plane, meter_->significance(result.pose.plane), start.overlap};
  return outcome;
}

RefineOutcome PoseRefinement::choose(const std::vector<Placement>& placements, StageTimes& times,
                                     std::vector<std::pair<std::string, double>>& counts) const {
  if (placements.empty()) {
    return failed("the data association found nothing coherent within the prior's limits");
  }
  std::vector<std::optional<RefinedPose>> poses(placements.size());
  times.run("affine", [&] {
    for (std::size_t i = 0; i < placements.size(); ++i) {
      const paper::AffineEstimate fit =
          paper::estimateAffine(placements[i].matches, space_.scale_axes, options_.affine);
      if (fit.ok()) poses[i] = RefinedPose{fit.fixed_from_moving};
    }
  });
  return times.run("refine", [&]() -> RefineOutcome {
    if (options_.refine == RefineKind::kDense) return refineDensely(std::move(poses), counts);
    if (!poses.front()) return failed("the coherent matches determine no affine");
    return refineByPoints(*poses.front(), counts);
  });
}

verdict::Finding PoseRefinement::examine(const Eigen::Affine2d& pose, const RefineOutcome& outcome,
                                         double height_residual) const {
  verdict::Finding finding;
  finding.pose = pose;
  for (const RefinedPose& rival : outcome.rivals) finding.rivals.push_back(rival.significance);
  const double highest = finding.rivals.empty() ? 0.0 : finding.rivals.front();
  finding.evidence = meter_->measure(pose, space_, highest);
  const Level level = levelUnder(pose, kBlockFactor);
  finding.uncertainty =
      verdict::estimateUncertainty(level.fixed, level.moving, pose, finding.evidence, space_,
                                   height_residual, options_.uncertainty);
  return finding;
}

Fit PoseRefinement::fit(const Eigen::Affine2d& pose) const {
  const Level& level = levels_[kRankingLevel];
  double seen = 0.0, shared = 0.0, product = 0.0, fixed2 = 0.0, moving2 = 0.0;
  for (int r = 0; r < level.moving.frame.rows; ++r) {
    for (int c = 0; c < level.moving.frame.cols; ++c) {
      const std::size_t i = level.moving.weight.index(r, c);
      if (level.moving.weight[i] <= 0.0F) continue;
      seen += 1.0;
      const map::SignalSample look =
          map::sampleSignal(level.fixed, pose * level.moving.frame.centre(r, c));
      if (look.weight <= 0.0F) continue;
      shared += 1.0;
      for (int k = 0; k < map::kSignalChannels; ++k) {
        const auto f = static_cast<double>(look.value[k]);
        const auto m = static_cast<double>(level.moving.channel[k][i]);
        product += f * m;
        fixed2 += f * f;
        moving2 += m * m;
      }
    }
  }
  Fit fit;
  if (seen > 0.0) fit.overlap = shared / seen;
  if (fixed2 > 0.0 && moving2 > 0.0) fit.correlation = product / std::sqrt(fixed2 * moving2);
  return fit;
}

}  // namespace agricolmap::pipeline
