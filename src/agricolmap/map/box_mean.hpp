// Weighted means over squares of cells: what is usual around each.
#pragma once

#include "agricolmap/core/raster.hpp"

namespace agricolmap::map {

/// Means of several rasters under the same weights, whose own sums are made once. The time does not
/// hang on the radius.
class BoxMean {
 public:
  /// `weight` must outlive this; squares of 2·`radius` + 1 cells.
  BoxMean(const Raster<float>& weight, int radius);
  /// Per cell the mean of a raster of the weights' size over the square around it; 0 where the
  /// weights are.
  Raster<float> of(const Raster<float>& value) const;

 private:
  const Raster<float>& weight_;
  int radius_;
  Raster<float> norm_;
};

}  // namespace agricolmap::map
