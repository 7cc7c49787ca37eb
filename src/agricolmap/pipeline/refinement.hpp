// Stages 6 and 7: from placements to one refined pose.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/pipeline/options.hpp"

namespace agricolmap::pipeline {

/// A pose of the moving map, levelled moving → levelled fixed.
struct RefinedPose {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();
  double significance = 0.0;  ///< whitened score at the ranking level, see EvidenceMeter
  double overlap = 0.0;       ///< share of the moving map's cells with a fixed cell to compare with
};

/// The winner, or why there is none.
struct RefineOutcome {
  std::optional<RefinedPose> best;
  /// Other places that held when refined to the ranking level, most significant first.
  std::vector<RefinedPose> rivals;
  std::string failure;  ///< in plain words when there is no winner
};

/// How well two maps fit under a pose.
struct Fit {
  double overlap = 0.0;      ///< share of the moving map's seen cells that the fixed map sees
  double correlation = 0.0;  ///< of the signals of both channels over the overlap
};

/// Holds the signal maps of one pair at the cell sizes of the refinement.
class PoseRefinement {
 public:
  PoseRefinement(const map::GridMap& fixed, const map::GridMap& moving, const SearchSpace& space,
                 const RegistrationOptions& options);

  /// Estimates an affine from each placement (stage 6) and refines (stage 7): densely, all
  /// placements through the coarse levels and the most significant one to the finest; or, as in the
  /// paper, the placement with most votes by CPD on the vegetation points.
  RefineOutcome choose(const std::vector<Placement>& placements, StageTimes& times,
                       std::vector<std::pair<std::string, double>>& counts) const;
  /// Refines one pose densely, from the ranking level on; nothing when it does not hold.
  std::optional<RefinedPose> refineFrom(const Eigen::Affine2d& pose) const;
  /// What the verdict rests on, for the refined `pose` of an outcome. `height_residual`: robust
  /// deviation of the ground's heights [m].
  verdict::Finding examine(const Eigen::Affine2d& pose, const RefineOutcome& outcome,
                           double height_residual) const;
  /// At the ranking level: finer maps may be sparser than their cells.
  Fit fit(const Eigen::Affine2d& pose) const;

 private:
  struct Level {
    map::SignalMap fixed;
    map::SignalMap moving;
  };
  /// The fixed map where the pose puts the moving one, and `rim` more [m].
  map::GridMap fixedUnder(const Eigen::Affine2d& pose, double rim) const;
  /// Both maps at `factor` grid cells, the fixed one only where the pose puts the moving one.
  Level levelUnder(const Eigen::Affine2d& pose, int factor) const;
  std::optional<RefinedPose> refineAt(const Level& level, const RefinedPose& start,
                                      bool across_basins = false) const;
  /// The best of the poses and its rivals, at the ranking level.
  RefineOutcome rank(const std::vector<std::optional<RefinedPose>>& poses) const;
  RefineOutcome refineDensely(std::vector<std::optional<RefinedPose>> poses,
                              std::vector<std::pair<std::string, double>>& counts) const;
  /// Through the cells finer than the ranking level.
  RefinedPose refineFinely(const RefinedPose& start) const;
  RefineOutcome refineByPoints(const RefinedPose& start,
                               std::vector<std::pair<std::string, double>>& counts) const;

  const map::GridMap& fixed_;
  const map::GridMap& moving_;
  map::GridMap
      filled_;  ///< the moving map with what plants hide from its camera, for the fine levels
  const SearchSpace& space_;
  const RegistrationOptions& options_;
  std::vector<Level> levels_;                      ///< of the whole maps, coarse to fine: 12, 6 cm
  std::unique_ptr<verdict::EvidenceMeter> meter_;  ///< at the ranking level, the second
};

}  // namespace agricolmap::pipeline
