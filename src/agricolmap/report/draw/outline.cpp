#include "agricolmap/report/draw/outline.hpp"

#include <algorithm>
#include <limits>

namespace agricolmap::report {
namespace {

/// Positive when the way from `a` over `b` to `c` turns left.
double turn(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d u = b - a;
  const Eigen::Vector2d v = c - a;
  return u.x() * v.y() - u.y() * v.x();
}

}  // namespace

std::vector<Eigen::Vector2d> convexHull(std::vector<Eigen::Vector2d> points) {
  if (points.size() < 3) return points;
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
  });
  std::vector<Eigen::Vector2d> hull;
  // The lower chain from west to east, then the upper one back.
  for (int chain = 0; chain < 2; ++chain) {
    const std::size_t begin = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() >= begin + 2 && turn(hull[hull.size() - 2], hull.back(), p) <= 0.0) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();  // it begins the other chain
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

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
