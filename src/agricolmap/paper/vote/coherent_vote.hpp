// The coherent part of a flow (paper Sec. III-B: "a voting scheme inspired by the Hough
// transform").
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/core/scaled_rotation.hpp"
#include "agricolmap/core/search_space.hpp"

namespace agricolmap::paper {

/// What the matches vote for.
enum class VoteKind {
  kPose,          ///< heading, two scales and a displacement; not in the paper
  kDisplacement,  ///< one displacement, as the paper says
};

struct VoteOptions {
  VoteKind kind = VoteKind::kPose;
  double step = 1.0;       ///< t_f (Tab. III): step of the vote [cells]
  double coarse = 8.0;     ///< step of the search over heading and scales, for poses [t_f]
  double tolerance = 5.0;  ///< largest distance of a match from its pose, for poses [t_f]
  int placements = 5;      ///< distinct placements to return at most
  int least = 12;          ///< votes that a placement needs
};
void listOptions(OptionTable& table, VoteOptions& options);

/// A placement and the matches (indices) within the tolerance of it.
struct VotedPlacement {
  ScaledRotation pose;
  std::vector<std::uint32_t> inliers;
};

/// The matches that `options.kind` calls coherent, best-supported placement first: voteDisplacement
/// where that is kDisplacement, and else those that one rotation, two scales and a shift explain.
///
/// Where heading or scale is off, the true flow varies along the strip (2 m over 10 m at 0.2 rad),
/// so a vote for one displacement keeps a short band of it. Here every (heading, scales) on a
/// lattice over what the initial guess allows, with steps that move no match by more than half of
/// `coarse`, votes for a displacement; the fullest bins are then drawn in to `tolerance` by
/// alternating closed-form fits and selection. `cell` is t_f's unit [m].
std::vector<VotedPlacement> voteCoherent(std::span<const Match> matches, const SearchSpace& space,
                                         double cell, const VoteOptions& options);

/// The paper's vote: matches count in square bins of t_f over their displacement, and those of the
/// fullest bin are the coherent ones. Further placements are the next fullest bins that touch none
/// of those before. `pose` is the fit to a bin's matches, or its mean displacement where they lie
/// on a line. `axes` as SearchSpace::scale_axes.
std::vector<VotedPlacement> voteDisplacement(std::span<const Match> matches,
                                             const Eigen::Matrix2d& axes, double cell,
                                             const VoteOptions& options);

}  // namespace agricolmap::paper
