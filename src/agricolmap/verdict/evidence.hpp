// What speaks for and against a registration, measured on the pair itself: no threshold on a raw
// correlation, which differs from crop to crop more than between right and wrong.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/correlation/matched_filter.hpp"
#include "agricolmap/locate/association.hpp"
#include "agricolmap/map/blocks.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::verdict {

struct EvidenceOptions {
  double block = 1.2;        ///< side of the blocks that are placed alone, at most [m]
  double block_reach = 0.5;  ///< how far from its predicted place a block is looked for [m]
  double agreement = 0.08;   ///< a block agrees when its best place is this near [m]
  double exclusion = 0.35;   ///< other peaks are counted from this distance on [m]
  correlation::MatchedFilterOptions filter;  ///< not listed: the search's, too
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
  double block_side = 0.0;    ///< [m]
  std::vector<BlockEvidence> blocks;  ///< those with enough seen cells in both maps
  std::size_t agreeing = 0;
  double agreement() const {
    return blocks.empty() ? 0.0
                          : static_cast<double>(agreeing) / static_cast<double>(blocks.size());
  }
};

/// Side of the blocks [m]: at least a dozen of them where the strip is large enough for that.
double blockSide(const map::StripFrame& strip, const EvidenceOptions& options);

/// Measures evidence for poses of one pair at one cell size.
class EvidenceMeter {
 public:
  EvidenceMeter(const map::SignalMap& fixed, const map::SignalMap& moving,
                const EvidenceOptions& options);

  /// Whitened score of the whole moving map under `pose`, in deviations of the score over the map:
  /// comparable between poses of the pair, since it does not grow when a map shrinks.
  double significance(const Eigen::Affine2d& pose) const;
  /// Everything. Other peaks are sought among the shifts that `space` allows; `rival` is the
  /// significance of the best other placement, whatever its heading and scales, 0 if there is none.
  Evidence measure(const Eigen::Affine2d& pose, const SearchSpace& space, double rival) const;

  /// Largest distance between where two poses put a corner of the strip [m].
  double distance(const Eigen::Affine2d& a, const Eigen::Affine2d& b) const;

 private:
  /// The whole moving map under the pose's linear part.
  correlation::Template wholeTemplate(const Eigen::Affine2d& pose) const;
  /// A template's score at a pose, in deviations of what chance gives to as large a part of it as
  /// lies on the fixed map.
  double significance(const correlation::Template& piece, double deviation,
                      const Eigen::Affine2d& pose) const;
  /// Highest score of a shift within `radius` of `centre` and not about `peak` (col, row) [cells].
  double highestOther(const correlation::ComplexRaster& surface, const Eigen::Vector2d& centre,
                      double radius, const Eigen::Vector2d& peak) const;
  BlockEvidence placeBlock(const map::Block& block, const Eigen::Affine2d& pose,
                           bool& usable) const;
  /// Whether the fixed map has seen enough of the square of half a side `half` around a cell.
  bool seenAround(const Eigen::Vector2d& at, double half) const;
  /// Scores of a block's shifts by up to `reach` cells, the unshifted one in the middle.
  Raster<float> blockScores(const correlation::Template& piece, const Eigen::Vector2d& at,
                            int reach) const;

  const map::SignalMap& moving_;
  const map::SignalMap& fixed_;
  EvidenceOptions options_;
  correlation::MatchedFilter filter_;
  map::StripFrame strip_;
};

}  // namespace agricolmap::verdict
