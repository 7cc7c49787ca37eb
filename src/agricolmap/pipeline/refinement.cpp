#include "agricolmap/pipeline/refinement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap {
namespace {

// Cells of a level in grid cells: 12, 6, 4 and 2 cm with the default grid.
constexpr std::array<int, 4> kFactors = {6, 3, 2, 1};
constexpr std::size_t kRankingLevel = 1;
/// Finer cells must have at least this share of the coarser ones' overlap.
constexpr double kLeastFinerOverlap = 0.5;

}  // namespace

PoseRefinement::PoseRefinement(const GridMap& fixed, const GridMap& moving,
                               const SearchSpace& space, const RegistrationOptions& options)
    : fixed_(fixed), moving_(moving), space_(space), options_(options) {
  for (const int factor : kFactors) {
    levels_.push_back({makeSignalMap(fixed, factor, options.signal),
                       makeSignalMap(moving, factor, options.signal)});
  }
  meter_ = std::make_unique<EvidenceMeter>(levels_[kRankingLevel].fixed,
                                           levels_[kRankingLevel].moving, options.evidence);
}

std::optional<RefinedPose> PoseRefinement::refineAt(const Level& level,
                                                    const RefinedPose& start) const {
  const DenseRefineResult dense =
      refineDense(level.fixed, level.moving, start.pose, options_.dense);
  if (dense.status != RefineStatus::kConverged) return std::nullopt;
  return RefinedPose{dense.fixed_from_moving, start.significance, dense.overlap};
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
  RefineOutcome outcome;
  double survivors = 0.0;
  for (const auto& pose : poses) {
    if (!pose) continue;
    survivors += 1.0;
    if (!outcome.best || pose->significance > outcome.best->significance) outcome.best = pose;
  }
  counts.emplace_back("refined_placements", survivors);
  // What the finest cells cannot follow (a map with fewer points than cells has hardly two seen
  // side by side) stays as the coarser ones left it; whether it is right is for the verdict to say.
  for (std::size_t level = kRankingLevel + 1; level < levels_.size() && outcome.best; ++level) {
    const std::optional<RefinedPose> finer = refineAt(levels_[level], *outcome.best);
    if (!finer || finer->overlap < kLeastFinerOverlap * outcome.best->overlap) break;
    outcome.best = finer;
  }
  if (!outcome.best) {
    outcome.failure =
        "no placement of the moving map holds when refined: the maps have nothing coherent in "
        "common within the prior's limits";
  }
  return outcome;
}

RefineOutcome PoseRefinement::refineByPoints(
    const RefinedPose& start, std::vector<std::pair<std::string, double>>& counts) const {
  const Vegetation fixed = extractVegetation(fixed_, options_.vegetation);
  const Vegetation moving = extractVegetation(moving_, options_.vegetation);
  for (const auto& [map, name] : {std::pair{&fixed, "fixed"}, {&moving, "moving"}}) {
    if (map->points.empty()) {
      return {std::nullopt, fmt::format("vegetation cannot be told from soil in the {} map: {}",
                                        name, describe(map->threshold.status))};
    }
  }
  // Heights start where the maps agree on the ground; the vertical stage has the last word.
  const VerticalResult vertical = fitVertical(fixed_, moving_, start.pose, options_.vertical);
  CpdPose pose;
  pose.plane = start.pose;
  pose.height_offset = vertical.status == VerticalStatus::kOk ? vertical.offset : 0.0;
  const CpdResult result =
      refineByCpd(fixed.points, moving.points, pose, options_.cpd, space_.scale_axes);
  counts.emplace_back("fixed_vegetation_points", static_cast<double>(fixed.points.size()));
  counts.emplace_back("moving_vegetation_points", static_cast<double>(moving.points.size()));
  counts.emplace_back("cpd_iterations", static_cast<double>(result.iterations));
  counts.emplace_back("cpd_matched_share", result.matched_share);
  if (!result.usable()) {
    return {std::nullopt, fmt::format("the point refinement failed: {}", describe(result.status))};
  }
  return {RefinedPose{result.pose.plane, meter_->significance(result.pose.plane), start.overlap},
          ""};
}

RefineOutcome PoseRefinement::choose(const std::vector<Placement>& placements, StageTimes& times,
                                     std::vector<std::pair<std::string, double>>& counts) const {
  if (placements.empty()) {
    return {std::nullopt, "the data association found nothing coherent within the prior's limits"};
  }
  std::vector<std::optional<RefinedPose>> poses(placements.size());
  times.run("affine", [&] {
    for (std::size_t i = 0; i < placements.size(); ++i) {
      const AffineEstimate fit =
          estimateAffine(placements[i].matches, space_.scale_axes, options_.affine);
      if (fit.ok()) poses[i] = RefinedPose{fit.fixed_from_moving};
    }
  });
  return times.run("refine", [&]() -> RefineOutcome {
    if (options_.refine == RefineKind::kDense || options_.refine == RefineKind::kDenseCpd) {
      RefineOutcome dense = refineDensely(std::move(poses), counts);
      if (!dense.best || options_.refine == RefineKind::kDense) return dense;
      // Closed canopy or a map without colours has no vegetation points; the report says so.
      const RefineOutcome points = refineByPoints(*dense.best, counts);
      counts.emplace_back("cpd_used", points.best ? 1.0 : 0.0);
      return points.best ? points : dense;
    }
    if (!poses.front()) return {std::nullopt, "the coherent matches determine no affine"};
    if (options_.refine == RefineKind::kCpd) return refineByPoints(*poses.front(), counts);
    poses.front()->significance = meter_->significance(poses.front()->pose);
    return {poses.front(), ""};
  });
}

Evidence PoseRefinement::evidence(const Eigen::Affine2d& pose) const {
  return meter_->measure(pose, space_);
}

Fit PoseRefinement::fit(const Eigen::Affine2d& pose) const {
  const Level& level = levels_[kRankingLevel];
  double seen = 0.0, shared = 0.0, product = 0.0, fixed2 = 0.0, moving2 = 0.0;
  for (int r = 0; r < level.moving.frame.rows; ++r) {
    for (int c = 0; c < level.moving.frame.cols; ++c) {
      const std::size_t i = level.moving.weight.index(r, c);
      if (level.moving.weight[i] <= 0.0F) continue;
      seen += 1.0;
      const SignalSample look = sampleSignal(level.fixed, pose * level.moving.frame.centre(r, c));
      if (look.weight <= 0.0F) continue;
      shared += 1.0;
      for (int k = 0; k < kSignalChannels; ++k) {
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

}  // namespace agricolmap
