// What speaks for and against a registration, measured on the pair itself: no threshold on a raw
// correlation, which differs from crop to crop more than between right and wrong.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/core/search_space.hpp"
#include "agricolmap/correlation/strip_score.hpp"
#include "agricolmap/map/blocks.hpp"
#include "agricolmap/verdict/parts.hpp"

namespace agricolmap::verdict {

struct EvidenceOptions {
  double block = 1.2;        ///< side of the blocks that are placed alone, at most [m]
  double block_reach = 0.5;  ///< how far from its predicted place a block is looked for [m]
  double agreement = 0.08;   ///< a block agrees when its best place is this near [m]
  double exclusion = 0.35;   ///< other peaks are counted from this distance on [m]
};
void listOptions(OptionTable& table, EvidenceOptions& options);

/// One block of the moving map, placed alone.
struct BlockEvidence {
  Eigen::Vector2d moving = Eigen::Vector2d::Zero();  ///< its centre, moving levelled frame [m]
  Eigen::Vector2d place = Eigen::Vector2d::Zero();   ///< predicted centre, fixed frame [m]
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< best place − predicted place [m]
  bool agrees = false;
};

struct Evidence {
  double significance = 0.0;  ///< peak over the deviation of the score over the searched shifts
  double uniqueness = 0.0;    ///< peak over the highest other one, of shifts and of placements
  /// Significances of mirrored copies of the moving map at their best; none where the place is
  /// clear without them.
  std::vector<double> decoys;
  map::StripFrame strip;    ///< the moving map's, along which the blocks are cut
  double block_side = 0.0;  ///< asked for [m]
  Eigen::Vector2d block_size = Eigen::Vector2d::Zero();  ///< as cut, along and across [m]
  std::vector<BlockEvidence> blocks;  ///< those with enough seen cells in both maps
  std::size_t agreeing = 0;
  PartsReport parts;  ///< that lie elsewhere than the pose says
  /// Peak over that of the best decoy; where there is none, over what decoys hardly ever surpass.
  double decoyRatio() const;
  double agreement() const {
    return blocks.empty() ? 0.0
                          : static_cast<double>(agreeing) / static_cast<double>(blocks.size());
  }
};

/// Side of the blocks [m]: at least a dozen of them where the strip is large enough for that.
double blockSide(const map::StripFrame& strip, const EvidenceOptions& options);

/// Everything. Other peaks are sought among the shifts that `space` allows; `rival` is the
/// significance of the best other placement, whatever its heading and scales, 0 if there is none.
Evidence measureEvidence(const correlation::StripScore& score, const Eigen::Affine2d& pose,
                         const SearchSpace& space, double rival, const EvidenceOptions& options);

/// Takes from the evidence for a strip that was bent straight what a bend with so many coefficients
/// (`freedom`) gains by chance: a wrong place fits better, too, on average by one squared deviation
/// for each. Rivals and decoys had no such freedom. Never below `before`, the significance of the
/// strip as it was.
void discountFreedom(Evidence& evidence, double before, double freedom);

}  // namespace agricolmap::verdict
