// What speaks for and against a registration, measured on the pair itself: no threshold on a raw
// correlation, which differs from crop to crop more than between right and wrong.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/2_grid/signal_map.hpp"
#include "agricolmap/4_associate/association.hpp"
#include "agricolmap/4_associate/correlate/blocks.hpp"
#include "agricolmap/4_associate/correlate/matched_filter.hpp"

namespace agricolmap {

struct EvidenceOptions {
  double block = 1.2;        ///< side of the blocks that are placed alone [m]
  double block_reach = 0.5;  ///< how far from its predicted place a block is looked for [m]
  double agreement = 0.08;   ///< a block agrees when its best place is this near [m]
  double exclusion = 0.35;   ///< other peaks are counted from this distance on [m]
  MatchedFilterOptions filter;
};
void describe(OptionTable& table, EvidenceOptions& options);

/// One block of the moving map, placed alone.
struct BlockEvidence {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();   ///< predicted centre, fixed frame [m]
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();  ///< best place − predicted place [m]
  bool agrees = false;
};

struct Evidence {
  double significance = 0.0;  ///< peak over the deviation of the score over the searched shifts
  double uniqueness = 0.0;    ///< peak over the highest other peak of the searched shifts
  std::vector<BlockEvidence> blocks;  ///< those with enough seen cells in both maps
  std::size_t agreeing = 0;
  double agreement() const {
    return blocks.empty() ? 0.0
                          : static_cast<double>(agreeing) / static_cast<double>(blocks.size());
  }
};

/// Measures evidence for poses of one pair at one cell size.
class EvidenceMeter {
 public:
  EvidenceMeter(const SignalMap& fixed, const SignalMap& moving, const EvidenceOptions& options);

  /// Whitened score of the whole moving map under `pose`, in deviations of the score over the map:
  /// comparable between poses of the pair, since it does not grow when a map shrinks.
  double significance(const Eigen::Affine2d& pose) const;
  /// Everything, with other peaks sought among the shifts that `space` allows.
  Evidence measure(const Eigen::Affine2d& pose, const SearchSpace& space) const;

 private:
  /// Scores of all shifts of the whole map under the pose's linear part; `at` is the cell that the
  /// pose predicts.
  ComplexRaster wholeSurface(const Eigen::Affine2d& pose, Eigen::Vector2d& at) const;
  BlockEvidence placeBlock(const Block& block, const Eigen::Affine2d& pose, bool& usable) const;

  const SignalMap& moving_;
  const SignalMap& fixed_;
  EvidenceOptions options_;
  MatchedFilter filter_;
  StripFrame strip_;
};

}  // namespace agricolmap
