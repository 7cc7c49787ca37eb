// What is measured at a pose, and the verdict that rests on it.
#pragma once

#include <optional>
#include <vector>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/deform/deform.hpp"
#include "agricolmap/pipeline/maps.hpp"
#include "agricolmap/pipeline/refinement.hpp"
#include "agricolmap/refine/vertical.hpp"
#include "agricolmap/verdict/verdict.hpp"

namespace agricolmap::pipeline {

/// A bend or slip of the strip that is followed.
struct Followed {
  deform::Bend bend;
  /// The moving map without it, levelled moving frame: what all else of a Placed was measured on.
  map::GridMap straight;
  /// What the longest stretch without a slip is moved by, see deform::moveOfLongestStretch.
  Eigen::Affine2d longest = Eigen::Affine2d::Identity();
};

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
  std::optional<Followed> followed;  ///< on top of the pose; nothing: the pose is all
};

/// Heights and evidence at a pose.
Placed measure(const refine::PairSignals& signals, const SearchSpace& space,
               const refine::RefinedPose& found, const Refined& refined,
               const RegistrationOptions& options, Monitor& monitor);

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
                             const PairMaps& maps, const RegistrationOptions& options);

}  // namespace agricolmap::pipeline
