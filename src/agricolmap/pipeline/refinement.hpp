// Stages 6 and 7: from placements to one refined pose.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/pipeline/options.hpp"

namespace agricolmap {

/// A pose of the moving map, levelled moving → levelled fixed.
struct RefinedPose {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  double significance = 0.0;
  double overlap = 0.0;
  double correlation = 0.0;
};

/// Holds the signal maps of one pair at the cell sizes of the refinement.
class PoseRefinement {
 public:
  PoseRefinement(const GridMap& fixed, const GridMap& moving, const SearchSpace& space,
                 const RegistrationOptions& options);

  /// Estimates an affine from each placement (stage 6), refines them through the coarse levels,
  /// keeps the most significant and refines it to the finest level (stage 7). Empty if none
  /// survives.
  std::optional<RefinedPose> choose(const std::vector<Placement>& placements, StageTimes& times,
                                    std::vector<std::pair<std::string, double>>& counts) const;
  Evidence evidence(const Eigen::Affine2d& pose) const;

 private:
  struct Level {
    int factor;
    SignalMap fixed;
    SignalMap moving;
  };
  std::optional<RefinedPose> refineAt(const Level& level, const RefinedPose& start) const;

  const GridMap& fixed_;
  const GridMap& moving_;
  const SearchSpace& space_;
  const RegistrationOptions& options_;
  std::vector<Level> levels_;             ///< coarse to fine: 12, 6, 4, 2 cm for cells of 2 cm
  std::unique_ptr<EvidenceMeter> meter_;  ///< at the second level
};

}  // namespace agricolmap
