// What the peers are given of a pair: levelled, gridded maps and the vegetation points, made by the
// product's own first stages with the paper's parameters; and the way back to file coordinates.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "agricolmap/core/placement.hpp"
#include "agricolmap/map/signal_map.hpp"
#include "agricolmap/map/vegetation.hpp"
#include "agricolmap/pipeline/pair_maps.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// Stages level and grid of the paper preset. Levelling and gridding are given to all peers alike:
/// a method that works in the plane would else lose by a tilt that the ground says for nothing.
struct PeerMaps {
  pipeline::PairFrames frames;
  SearchSpace space;
  map::GridMap fixed;   ///< what the moving map can reach, levelled fixed frame
  map::GridMap moving;  ///< levelled moving frame: the guess is applied
};

/// Throws InputError for clouds that cannot be used, or have no colours.
PeerMaps makePeerMaps(const MethodInput& input, MethodTimes& times);

/// Vegetation points of both maps in the levelled frames [m].
struct PeerPoints {
  std::vector<map::VegetationPoint> fixed;
  std::vector<map::VegetationPoint> moving;
};

/// The points above each map's threshold on Excess Green, merged to squares so that at most the
/// given number is left. The fixed ones are those within `rim` [m] of the moving map as guessed.
/// Throws InputError where plants cannot be told from soil or one side has fewer than 20 points.
PeerPoints makePeerPoints(const PeerMaps& maps, double rim, std::size_t most_fixed,
                          std::size_t most_moving, MethodTimes& times);

/// Sets the transform to a pose in the plane (levelled moving → levelled fixed); offset and tilt
/// come from the ground, by the product's vertical stage. `why` when the heights do not fit.
void setPlanePose(const PeerMaps& maps, const MethodInput& input, const Eigen::Affine2d& pose,
                  MethodOutcome& outcome);

/// Sets the transform to one between the levelled frames.
void setLevelledPose(const PeerMaps& maps, const MethodInput& input, const Eigen::Affine3d& pose,
                     MethodOutcome& outcome);

/// Tells the counts of matches in the levelled frames as the facts `name`, `name_right` (where the
/// truth is known) and `name_coherent`.
void addMatches(const std::string& name, const pipeline::PairFrames& frames,
                const MethodInput& input, const std::vector<Match>& matches, double coherent,
                MethodOutcome& outcome);

}  // namespace agricolmap::experiments
