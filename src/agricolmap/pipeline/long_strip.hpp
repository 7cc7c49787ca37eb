// A strip so long that dead reckoning bends it beyond what one pose undoes: it is found by one of
// its pieces, followed from there along its path, and laid straight before it is looked at as a
// whole.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/pieces/chain.hpp"
#include "agricolmap/pipeline/judgement.hpp"
#include "agricolmap/pipeline/maps.hpp"

namespace agricolmap::pipeline {

/// Where the robot drove, in the moving map. `places`: of the robot, in the moving file's
/// coordinates; none: the shape of a long strip tells, and nothing that of a short one. Warns where
/// the strip is long and its shape does not, and where a path makes no difference.
std::optional<deform::Path> pathOf(const Cloud& moving, const std::vector<Eigen::Vector3d>& places,
                                   const PairMaps& maps, const RegistrationOptions& options,
                                   Monitor& monitor);

/// What the guess may be wrong by of a part of a strip, and of the nearest pose of one that is
/// bent: `drift` of dead reckoning, a share of the way, comes on top, in heading and scales.
PriorUncertainty withDrift(PriorUncertainty prior, double drift);

/// The maps of the piece about `along`, as long as the search looks for, and of what it can reach;
/// nothing when the guess lays it beside the fixed map.
std::optional<PairMaps> mapsOfPiece(const PairMaps& whole, const deform::Path& path, double along,
                                    const RegistrationOptions& options);

/// The fixed map as far as the strip can lie in it, whose piece about `along` has `pose`.
map::GridMap fixedAlong(const PairMaps& maps, const deform::Path& path, double along,
                        const Eigen::Affine2d& pose, const RegistrationOptions& options);

/// The chain from a piece's pose, and the same as one pose and a bend.
struct FollowedPieces {
  std::vector<pieces::PiecePose> chain;
  std::optional<pieces::Joined> joined;
  double significance = 0.0;
};
/// From each of `poses` of the piece about `along`, those from which most pieces are found; the
/// most significant first, that one with what its pieces' heights are short of.
std::vector<FollowedPieces> followFrom(const std::vector<Eigen::Affine2d>& poses,
                                       const refine::PairSignals& signals, const deform::Path& path,
                                       double along, const RegistrationOptions& options);

/// Makes what the pieces bend by, and what was followed of the straight strip on top of it, one
/// deformation of the strip as it is: `placed`, measured on `straight`, follows it.
void followPieces(const FollowedPieces& followed, const deform::Path& path,
                  const map::GridMap& straight, const RegistrationOptions& options, Placed& placed);
/// How many pieces were found, and what they bend by, in plain words.
std::string describe(const FollowedPieces& followed);

/// The part of the strip's ends that were not found although the fixed map shows where they should
/// be, in plain words, and how long it is [m]; empty when there is none to speak of.
struct LostEnd {
  std::string words;
  double length = 0.0;
};
std::optional<LostEnd> lostEnd(const FollowedPieces& followed, const deform::Path& path,
                               const map::SignalMap& fixed);

}  // namespace agricolmap::pipeline
