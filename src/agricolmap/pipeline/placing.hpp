// Stages 3 to 8 on gridded maps: where the moving map lies and whether that can be trusted.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/pipeline/refinement.hpp"

namespace agricolmap::pipeline {

/// Another place where the moving map fits.
struct Alternative {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();  ///< levelled moving → levelled fixed
  /// Moving file → fixed file coordinates [m].
  Eigen::Affine3d fixed_from_moving = Eigen::Affine3d::Identity();
  double significance = 0.0;  ///< see Evidence
};

/// Where a moving map was placed, in the levelled frames. `has_transform == false`: nowhere.
struct PairOutcome {
  verdict::Verdict verdict;
  bool has_transform = false;
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();  ///< levelled moving → levelled fixed
  refine::VerticalResult vertical;
  verdict::Evidence evidence;
  std::optional<verdict::PoseUncertainty>
      uncertainty;  ///< nothing when too few blocks can be compared
  /// Other places, listed when the status is ambiguous, most significant first.
  std::vector<Alternative> alternatives;
  double overlap = 0.0;      ///< share of the moving map's cells that the fixed map sees
  double correlation = 0.0;  ///< of the dense signals at the end
  std::vector<std::pair<std::string, double>> counts;  ///< per stage, in order
  locate::AssociationResult association;
  std::vector<RefinedPose> rivals;  ///< other places that held when refined
};

/// True when `a` is to be preferred to `b`: accepted first, then ambiguous, then more probable.
bool better(const PairOutcome& a, const PairOutcome& b);
/// True when the outcome of a later search replaces an earlier one of the same maps. Places that
/// could not be told apart are not forgotten because a later search misses some of them: after an
/// ambiguous outcome counts only a place that none of them rivals (`VerdictOptions::rival`).
bool supersedes(const PairOutcome& later, const PairOutcome& earlier, double rival);

/// Places the maps of one pair.
class PairPlacer {
 public:
  /// All references must outlive this. `association` takes the place of the one that the options
  /// name; nullptr: theirs.
  PairPlacer(const map::GridMap& fixed, const map::GridMap& moving, const SearchSpace& space,
             const RegistrationOptions& options, StageTimes& times,
             const locate::Association* association = nullptr)
      : fixed_(fixed),
        moving_(moving),
        space_(space),
        options_(options),
        times_(times),
        association_(association),
        refinement_(fixed, moving, space, options) {}

  /// Searches, first coarsely and, where that is not accepted, more finely and freely.
  PairOutcome search() const;
  /// One search, the `attempt`-th of `search()`, from 0; nothing when it would find nothing new
  /// after `before`.
  std::optional<PairOutcome> searchOnce(std::size_t attempt, const PairOutcome* before) const;
  /// From a placement that is known already, with its rivals.
  PairOutcome settle(const Placement& placement, std::vector<RefinedPose> rivals) const;

 private:
  /// A pose with all that the verdict rests on.
  struct Judged {
    Eigen::Affine2d pose;
    refine::VerticalResult vertical;
    verdict::Finding finding;
    double correlation;
  };
  Judged judgePose(const Eigen::Affine2d& pose, const RefineOutcome& refined) const;
  /// Lays a strip of which whole parts are displaced by these; whether that was tried and did good.
  std::optional<bool> straighten(const RefineOutcome& refined, Judged& judged) const;
  void judgeOutcome(const RefineOutcome& refined, PairOutcome& outcome) const;

  const map::GridMap& fixed_;
  const map::GridMap& moving_;
  const SearchSpace& space_;
  const RegistrationOptions& options_;
  StageTimes& times_;
  const locate::Association* association_;
  PoseRefinement refinement_;
};

}  // namespace agricolmap::pipeline
