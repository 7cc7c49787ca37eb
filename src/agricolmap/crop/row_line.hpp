// The centre line of a row.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/core/raster.hpp"

namespace agricolmap::crop {

/// A place of a row: where, and which way the row runs there.
struct RowPlace {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();   ///< [m]
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< unit vector
  Eigen::Vector2d left() const { return {-along.y(), along.x()}; }
};

/// A polyline measured along itself from its beginning.
class RowLine {
 public:
  RowLine() = default;
  /// Two points or more, none equal to its neighbour.
  explicit RowLine(std::vector<Eigen::Vector2d> points);

  const std::vector<Eigen::Vector2d>& points() const { return points_; }
  double length() const { return from_.empty() ? 0.0 : from_.back(); }
  /// At `s` metres from the beginning; beyond the ends straight on.
  RowPlace at(double s) const;

 private:
  std::size_t segmentAt(double s) const;
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> from_;  ///< beginning of each segment, and the end [m]
};

/// What lies along a row, laid straight: column 0 at its beginning, the middle row on its line,
/// rows to its left above.
struct Straightened {
  double step = 0.0;  ///< [m]
  Raster<float> values;
  int middle() const { return values.rows() / 2; }
  double along(int col) const { return (col + 0.5) * step; }
};

/// `half` metres to each side; bilinear between known cells, NaN where none is.
Straightened straighten(const GridFrame& frame, const Raster<float>& raster, const RowLine& line,
                        double half, double step);

/// Bilinear between the known ones of four cells; NaN where none is, or outside.
float knownValue(const GridFrame& frame, const Raster<float>& raster, const Eigen::Vector2d& point);

}  // namespace agricolmap::crop
