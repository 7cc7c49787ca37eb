#include "agricolmap/crop/row_line.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/crop/view.hpp"

namespace agricolmap::crop {

RowLine::RowLine(std::vector<Eigen::Vector2d> points) : points_(std::move(points)) {
  from_.reserve(points_.size());
  from_.push_back(0.0);
  for (std::size_t i = 1; i < points_.size(); ++i) {
    from_.push_back(from_.back() + (points_[i] - points_[i - 1]).norm());
  }
}

std::size_t RowLine::segmentAt(double s) const {
  const auto next = std::upper_bound(from_.begin(), from_.end(), s);
  const auto index =
      static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, next - from_.begin() - 1));
  return std::min(index, points_.size() - 2);
}

RowPlace RowLine::at(double s) const {
  const std::size_t i = segmentAt(s);
  const Eigen::Vector2d along = (points_[i + 1] - points_[i]).normalized();
  return {points_[i] + (s - from_[i]) * along, along};
}

float knownValue(const GridFrame& frame, const Raster<float>& raster,
                 const Eigen::Vector2d& point) {
  const Eigen::Vector2d cell = frame.cellOf(point);
  const double x = std::floor(cell.x());
  const double y = std::floor(cell.y());
  const auto fx = static_cast<float>(cell.x() - x);
  const auto fy = static_cast<float>(cell.y() - y);
  const auto col = static_cast<int>(x);
  const auto row = static_cast<int>(y);
  float sum = 0.0F;
  float weight = 0.0F;
  for (int dy = 0; dy < 2; ++dy) {
    for (int dx = 0; dx < 2; ++dx) {
      if (!raster.contains(row + dy, col + dx)) continue;
      const float value = raster(row + dy, col + dx);
      if (!std::isfinite(value)) continue;
      const float w = 1e-3F + (dx == 1 ? fx : 1.0F - fx) * (dy == 1 ? fy : 1.0F - fy);
      sum += w * value;
      weight += w;
    }
  }
  return weight > 0.0F ? sum / weight : kUnknown;
}

Straightened straighten(const GridFrame& frame, const Raster<float>& raster, const RowLine& line,
                        double half, double step) {
  Straightened result;
  result.step = step;
  const int side = std::max(1, static_cast<int>(std::ceil(half / step)));
  const int cols = std::max(1, static_cast<int>(std::floor(line.length() / step)));
  result.values = Raster<float>(2 * side + 1, cols, kUnknown);
  for (int c = 0; c < cols; ++c) {
    const RowPlace place = line.at(result.along(c));
    for (int r = 0; r <= 2 * side; ++r) {
      result.values(r, c) =
          knownValue(frame, raster, place.point + (step * (r - side)) * place.left());
    }
  }
  return result;
}

}  // namespace agricolmap::crop
