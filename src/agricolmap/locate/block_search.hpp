// Where does the strip fit under one coarse hypothesis of heading and scales, and under the finer
// ones near to it?
//
// The strip is cut into blocks, small enough to tolerate the coarse step, and each is correlated
// with the whole map once. Under a finer hypothesis a block's place differs from the coarse one's
// by a few cells; the largest score within those cells, summed over the blocks, is an upper bound
// for all of them at once. Only where that bound is high are the finer hypotheses looked at, one by
// one.
#pragma once

#include <vector>

#include "agricolmap/correlation/matched_filter.hpp"
#include "agricolmap/locate/candidates.hpp"

namespace agricolmap::locate {

class BlockSearch {
 public:
  /// `blocks`: those of the strip that take part. `peaks`: places per
  /// coarse hypothesis at which the finer ones are looked at. `min_inside`: least share of the
  /// blocks that lie in the map. All references must outlive this.
  BlockSearch(const map::SignalMap& moving, const correlation::MatchedFilter& filter,
              const SearchSpace& space, const map::StripFrame& strip,
              std::vector<map::Block> blocks, int peaks, double min_inside);

  /// The best of `fine` at each of the places. Scores: sum of the blocks' scores over the deviation
  /// of such a sum by chance, so that strips partly beyond the map's edge compare with others.
  std::vector<Candidate> run(const Hypothesis& coarse, const std::vector<Hypothesis>& fine) const;

 private:
  /// Score of a block's middle at each cell of the map and of the filter's rim around it.
  struct Surface {
    Raster<float> score;
    double variance = 0.0;
  };
  /// Cells (col, row) of the surface at which blocks lie when the strip is not shifted.
  using Offsets = std::vector<Eigen::Vector2i>;
  struct Peak {
    float score;
    Eigen::Vector2i shift;  ///< (col, row) of the search space's centre [cells]
  };

  std::vector<Surface> correlate(const Eigen::Matrix2d& linear) const;
  Offsets offsetsOf(const Hypothesis& hypothesis) const;
  std::vector<Peak> boundPeaks(const std::vector<Surface>& bounds, const Offsets& offsets) const;
  /// How much of a block whose middle lies at this cell of a surface takes part: all of it on the
  /// map, half in the rim, which is as wide as half a block.
  double insideShare(const Eigen::Vector2i& at) const;
  Candidate bestNear(const Peak& peak, const std::vector<Hypothesis>& fine,
                     const std::vector<Offsets>& fine_offsets,
                     const std::vector<Surface>& surfaces) const;

  const map::SignalMap& moving_;
  const correlation::MatchedFilter& filter_;
  const SearchSpace& space_;
  const map::StripFrame& strip_;
  std::vector<map::Block> blocks_;
  int peaks_;
  double min_inside_;
  Eigen::AlignedBox2i shifts_;  ///< (col, row) that the guess and the map allow [cells]
  double radius_;               ///< and their largest length [cells]
};

}  // namespace agricolmap::locate
