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
  double significance = 0.0;  ///< whitened score at the ranking level, see EvidenceMeter
  double overlap = 0.0;       ///< share of the moving map's cells with a fixed cell to compare with
};

/// The winner, or why there is none.
struct RefineOutcome {
  std::optional<RefinedPose> best;
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
  PoseRefinement(const GridMap& fixed, const GridMap& moving, const SearchSpace& space,
                 const RegistrationOptions& options);

  /// Estimates an affine from each placement (stage 6) and refines (stage 7): densely, all
  /// placements through the coarse levels and the most significant one to the finest; or, as in the
  /// paper, the placement with most votes by CPD on the vegetation points; or not at all.
  RefineOutcome choose(const std::vector<Placement>& placements, StageTimes& times,
                       std::vector<std::pair<std::string, double>>& counts) const;
  Evidence evidence(const Eigen::Affine2d& pose) const;
  /// At the ranking level: finer maps may be sparser than their cells.
  Fit fit(const Eigen::Affine2d& pose) const;

 private:
  struct Level {
    SignalMap fixed;
    SignalMap moving;
  };
  std::optional<RefinedPose> refineAt(const Level& level, const RefinedPose& start) const;
  RefineOutcome refineDensely(std::vector<std::optional<RefinedPose>> poses,
                              std::vector<std::pair<std::string, double>>& counts) const;
  RefineOutcome refineByPoints(const RefinedPose& start,
                               std::vector<std::pair<std::string, double>>& counts) const;

  const GridMap& fixed_;
  const GridMap& moving_;
  const SearchSpace& space_;
  const RegistrationOptions& options_;
  std::vector<Level> levels_;             ///< coarse to fine: 12, 6, 4, 2 cm for cells of 2 cm
  std::unique_ptr<EvidenceMeter> meter_;  ///< at the ranking level, the second
};

}  // namespace agricolmap
