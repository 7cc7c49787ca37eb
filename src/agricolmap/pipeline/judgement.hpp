// What is measured at a pose, and the verdict that rests on it.
#pragma once

#include <optional>
#include <vector>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/pipeline/refinement.hpp"
#include "agricolmap/refine/vertical.hpp"
#include "agricolmap/verdict/verdict.hpp"

namespace agricolmap::pipeline {

/// A pose of the moving map with all that was measured there.
struct Placed {
  Eigen::Affine2d pose = Eigen::Affine2d::Identity();  ///< levelled moving → levelled fixed
  std::size_t placement = 0;  ///< index of the placement that it was refined from
  refine::VerticalResult heights;
  verdict::HeightsVerdict heights_verdict;
  verdict::Evidence evidence;
  std::optional<verdict::PoseUncertainty> uncertainty;  ///< nothing when few blocks can be compared
  double overlap = 0.0;       ///< share of the moving map's cells that the fixed map sees
  double correlation = 0.0;   ///< of the dense signals
  double refined_cell = 0.0;  ///< of the finest map that the refinement could follow [m]; 0: none
};

/// Heights and evidence at the refined pose and, where neighbouring blocks of the strip are
/// displaced alike, at the pose that lays them straight, if that fits better in every respect. Of a
/// strip in two parts, at the pose of the larger one.
struct Measured {
  Placed placed;
  std::optional<bool> straightened;  ///< whether that did good; nothing: was not tried
};
Measured measureStraightened(const refine::PairSignals& signals, const SearchSpace& space,
                             const Refined& refined, const RegistrationOptions& options,
                             Monitor& monitor);

/// `rivals`: other places that held when refined.
verdict::Verdict judgePlaced(const Placed& placed, const std::vector<refine::RefinedPose>& rivals,
                             const SearchSpace& space, const RegistrationOptions& options);

}  // namespace agricolmap::pipeline
