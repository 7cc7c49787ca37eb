#include "experiments/methods/nearest_points.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace agricolmap::experiments {

NearestPoints::NearestPoints(std::vector<Eigen::Vector3d> points, double bin)
    : points_(std::move(points)), bin_(bin) {
  if (points_.empty()) {
    begin_.assign(2, 0);
    return;
  }
  Eigen::Vector2d low = points_.front().head<2>();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector3d& p : points_) {
    low = low.cwiseMin(p.head<2>());
    high = high.cwiseMax(p.head<2>());
  }
  corner_ = low;
  cols_ = static_cast<int>((high.x() - low.x()) / bin_) + 1;
  rows_ = static_cast<int>((high.y() - low.y()) / bin_) + 1;
  const auto bin_of = [&](const Eigen::Vector3d& p) {
    return binOf(static_cast<int>((p.y() - low.y()) / bin_),
                 static_cast<int>((p.x() - low.x()) / bin_));
  };
  begin_.assign(binOf(rows_ - 1, cols_ - 1) + 2, 0);
  for (const Eigen::Vector3d& p : points_) ++begin_[bin_of(p) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  order_.resize(points_.size());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    order_[next[bin_of(points_[i])]++] = static_cast<std::uint32_t>(i);
  }
}

std::optional<NearestPoints::Neighbour> NearestPoints::nearest(const Eigen::Vector3d& query,
                                                               double most) const {
  if (points_.empty()) return std::nullopt;
  const Eigen::Vector2d at = (query.head<2>() - corner_) / bin_;
  const double reach = most / bin_ + 1.0;
  if (!(at.x() > -reach && at.y() > -reach && at.x() < cols_ + reach && at.y() < rows_ + reach)) {
    return std::nullopt;
  }
  const int row = static_cast<int>(std::floor(at.y()));
  const int col = static_cast<int>(std::floor(at.x()));
  // Distance from the query to the rim of its own bin: rings beyond the best found cannot win.
  const double inset =
      bin_ * std::min({at.x() - col, col + 1.0 - at.x(), at.y() - row, row + 1.0 - at.y()});
  double best = most * most;
  std::optional<Neighbour> found;
  const auto look = [&](int r, int c) {
    if (r < 0 || c < 0 || r >= rows_ || c >= cols_) return;
    const std::size_t b = binOf(r, c);
    for (std::uint32_t k = begin_[b]; k < begin_[b + 1]; ++k) {
      const double d = (points_[order_[k]] - query).squaredNorm();
      if (d > best || (d == best && found && order_[k] > found->index)) continue;
      best = d;
      found = Neighbour{order_[k], std::sqrt(d)};
    }
  };
  for (int ring = 0; ring == 0 || inset + (ring - 1) * bin_ <= std::sqrt(best); ++ring) {
    for (int c = col - ring; c <= col + ring; ++c) {
      look(row - ring, c);
      if (ring > 0) look(row + ring, c);
    }
    for (int r = row - ring + 1; r < row + ring; ++r) {
      look(r, col - ring);
      look(r, col + ring);
    }
  }
  return found;
}

}  // namespace agricolmap::experiments
