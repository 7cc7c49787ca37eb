#include "agricolmap/report/draw/outline.hpp"

#include <algorithm>
#include <limits>

namespace agricolmap::report {

GroundRect smallestRectangle(const std::vector<Eigen::Vector2d>& hull) {
  GroundRect best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    // One side of the smallest rectangle lies on a side of the hull.
    const Eigen::Vector2d side = hull[(i + 1) % hull.size()] - hull[i];
    if (!(side.norm() > 0.0)) continue;
    Eigen::Matrix2d axes;
    axes.col(0) = side.normalized();
    axes.col(1) = Eigen::Vector2d(-axes(1, 0), axes(0, 0));
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector2d& p : hull) box.extend((axes.transpose() * p).eval());
    const Eigen::Vector2d half = 0.5 * box.sizes();
    if (half.prod() >= least) continue;
    least = half.prod();
    best = {axes * box.center(), axes, half};
  }
  if (best.half_extent.y() > best.half_extent.x()) {
    std::swap(best.half_extent.x(), best.half_extent.y());
    const Eigen::Vector2d along = best.axes.col(1);
    best.axes.col(1) = -best.axes.col(0);
    best.axes.col(0) = along;
  }
  if (best.axes(0, 0) < 0.0) best.axes = -best.axes;
  return best;
}

}  // namespace agricolmap::report
