// The one score of a pose: the whitened correlation of the whole moving map with the fixed one, in
// deviations of what chance gives. Placements are ranked by it, and the verdict rests on it.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/correlation/matched_filter.hpp"
#include "agricolmap/map/blocks.hpp"

namespace agricolmap::correlation {

/// A pose's score and the highest of other places.
struct ScorePeaks {
  double significance = 0.0;  ///< of the pose
  double other = 0.0;  ///< of the best shift away from it under its heading and scales; may be < 0
};

class StripScore {
 public:
  /// `fixed`: the map that `filter` whitened; `moving`: of the same cell size. All must outlive
  /// this.
  StripScore(const map::SignalMap& fixed, const map::SignalMap& moving,
             const MatchedFilter& filter);

  /// Score under `pose`, in deviations of the score over the map: comparable between poses of the
  /// pair, since it does not grow when a map shrinks.
  double significance(const Eigen::Affine2d& pose) const;
  /// That, and the highest score of the shifts that put the strip's middle within `radius` [m] of
  /// `centre` (fixed frame) and further than `exclusion` [m] from the pose.
  ScorePeaks peaks(const Eigen::Affine2d& pose, const Eigen::Vector2d& centre, double radius,
                   double exclusion) const;
  /// Scores of a piece's shifts by up to `reach` cells about the whole cell nearest to `at`
  /// (col, row) [cells of the fixed map]; not in deviations.
  Raster<float> around(const Template& piece, const Eigen::Vector2d& at, int reach) const;
  /// Largest distance between where two poses put a corner of the strip [m].
  double distance(const Eigen::Affine2d& a, const Eigen::Affine2d& b) const;

  const map::SignalMap& fixed() const { return fixed_; }
  const map::SignalMap& moving() const { return moving_; }
  const map::StripFrame& strip() const { return strip_; }
  const MatchedFilterOptions& options() const { return filter_.options(); }

 private:
  /// The whole moving map under the pose's linear part.
  Template wholeTemplate(const Eigen::Affine2d& pose) const;
  /// A template's score at a pose, in deviations of what chance gives to as large a part of it as
  /// lies on the fixed map.
  double significance(const Template& piece, double deviation, const Eigen::Affine2d& pose) const;
  /// Highest score of a shift within `radius` of `centre` and not about `peak` (col, row) [cells].
  double highestOther(const ComplexRaster& surface, const Eigen::Vector2d& centre, double radius,
                      const Eigen::Vector2d& peak, double exclusion) const;

  /// Adds what one channel gives to `scores`, whose element (0, 0) lays the piece's at (row0,
  /// col0).
  void addScores(const Raster<float>& piece, const Raster<float>& map, int row0, int col0,
                 Raster<float>& scores) const;

  const map::SignalMap& fixed_;
  const map::SignalMap& moving_;
  const MatchedFilter& filter_;
  map::StripFrame strip_;
  double per_seen_cell_ =
      1.0;  ///< a deviation over the cells that were seen, in that over the FFT's
};

}  // namespace agricolmap::correlation
