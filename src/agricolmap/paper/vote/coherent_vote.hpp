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

struct VoteOptions {
  double step = 1.0;       ///< t_f (Tab. III): step of the vote [cells]
  double coarse = 8.0;     ///< step of the search over heading and scales [t_f]
  double tolerance = 5.0;  ///< largest distance of a coherent match from its placement [t_f]
  int placements = 5;      ///< distinct placements to return at most
  int least = 12;          ///< votes that a placement needs
};
void listOptions(OptionTable& table, VoteOptions& options);

/// A placement and the matches (indices) within the tolerance of it.
struct VotedPlacement {
  ScaledRotation pose;
  std::vector<std::uint32_t> inliers;
};

/// Matches that one rotation, two scales and a shift explain, best-supported placement first.
///
/// Where heading or scale is off, the true flow varies along the strip (2 m over 10 m at 0.2 rad),
/// so a vote for one displacement keeps a short band of it. Here every (heading, scales) on a
/// lattice over what the initial guess allows, with steps that move no match by more than half of
/// `coarse`, votes for a displacement; the fullest bins are then drawn in to `tolerance` by
/// alternating closed-form fits and selection. `cell` is t_f's unit [m].
std::vector<VotedPlacement> voteCoherent(std::span<const Match> matches, const SearchSpace& space,
                                         double cell, const VoteOptions& options);

}  // namespace agricolmap::paper
