#include "agricolmap/pipeline/refinement.hpp"

#include <algorithm>
#include <array>

#include "agricolmap/5_affine/estimate_affine.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap {
namespace {

// Cells of a level in grid cells: 12, 6, 4 and 2 cm with the default grid.
constexpr std::array<int, 4> kFactors = {6, 3, 2, 1};
constexpr std::size_t kRankingLevel = 1;

}  // namespace

PoseRefinement::PoseRefinement(const GridMap& fixed, const GridMap& moving,
                               const SearchSpace& space, const RegistrationOptions& options)
    : fixed_(fixed), moving_(moving), space_(space), options_(options) {
  for (const int factor : kFactors) {
    levels_.push_back({factor, makeSignalMap(fixed, factor, options.signal),
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
  RefinedPose refined = start;
  refined.pose = dense.fixed_from_moving;
  // Finer maps may be sparser than their cells: what overlaps is told at the ranking level.
  if (level.factor >= kFactors[kRankingLevel]) refined.overlap = dense.overlap;
  refined.correlation = dense.correlation;
  return refined;
}

std::optional<RefinedPose> PoseRefinement::choose(
    const std::vector<Placement>& placements, StageTimes& times,
    std::vector<std::pair<std::string, double>>& counts) const {
  std::vector<std::optional<RefinedPose>> poses(placements.size());
  times.run("affine", [&] {
    for (std::size_t i = 0; i < placements.size(); ++i) {
      const AffineEstimate fit =
          estimateAffine(placements[i].matches, space_.scale_axes, options_.affine);
      if (fit.ok()) poses[i] = RefinedPose{fit.fixed_from_moving, 0.0, 0.0, 0.0};
    }
  });
  return times.run("refine", [&]() -> std::optional<RefinedPose> {
    parallelFor(poses.size(), [&](std::size_t i) {
      for (std::size_t level = 0; level <= kRankingLevel && poses[i]; ++level) {
        poses[i] = refineAt(levels_[level], *poses[i]);
      }
      if (poses[i]) poses[i]->significance = meter_->significance(poses[i]->pose);
    });
    std::optional<RefinedPose> best;
    double survivors = 0.0;
    for (const auto& pose : poses) {
      if (!pose) continue;
      survivors += 1.0;
      if (!best || pose->significance > best->significance) best = pose;
    }
    counts.emplace_back("refined_placements", survivors);
    for (std::size_t level = kRankingLevel + 1; level < levels_.size() && best; ++level) {
      best = refineAt(levels_[level], *best);
    }
    return best;
  });
}

Evidence PoseRefinement::evidence(const Eigen::Affine2d& pose) const {
  return meter_->measure(pose, space_);
}

}  // namespace agricolmap
