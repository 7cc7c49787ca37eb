#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/map/vegetation.hpp"

namespace agricolmap::map {
namespace {

Box2 boxOf(const std::vector<VegetationPoint>& points) {
  Box2 box;
  for (const VegetationPoint& p : points) box.extend(p.position);
  return box;
}

/// Squares of one side over the box of some points, anchored at zero.
class Squares {
 public:
  Squares(const std::vector<VegetationPoint>& points, double side) : side_(side) {
    const Box2 box = boxOf(points);
    first_ = (box.min() / side).array().floor();
    const Eigen::Array2d count = (box.max() / side).array().floor() - first_ + 1.0;
    if (!(count.prod() < kMaxSquares)) {
      throw UsageError("the side of a thinning square is far too small for the extent of the map");
    }
    cols_ = static_cast<std::uint64_t>(count.x());
    squares_ = cols_ * static_cast<std::uint64_t>(count.y());
  }
  std::uint64_t key(const VegetationPoint& p) const {
    const Eigen::Array2d square = (p.position / side_).array().floor() - first_;
    return static_cast<std::uint64_t>(square.y()) * cols_ + static_cast<std::uint64_t>(square.x());
  }
  /// How many squares hold points.
  std::size_t occupied(const std::vector<VegetationPoint>& points) const {
    std::vector<bool> seen(squares_, false);
    std::size_t count = 0;
    for (const VegetationPoint& p : points) {
      const std::uint64_t square = key(p);
      count += seen[square] ? 0 : 1;
      seen[square] = true;
    }
    return count;
  }

 private:
  static constexpr double kMaxSquares = 4e9;
  double side_;
  Eigen::Array2d first_;
  std::uint64_t cols_ = 0;
  std::uint64_t squares_ = 0;
};

}  // namespace

std::vector<VegetationPoint> thinVegetation(const std::vector<VegetationPoint>& points,
                                            double voxel) {
  if (!(voxel > 0.0)) throw UsageError("the side of a thinning square must be positive");
  if (points.empty()) return {};
  const Squares squares(points, voxel);
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    keys[i] = {squares.key(points[i]), static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<VegetationPoint> thinned;
  for (std::size_t i = 0; i < keys.size();) {
    VegetationPoint sum;
    const std::uint64_t key = keys[i].first;
    for (; i < keys.size() && keys[i].first == key; ++i) {
      const VegetationPoint& p = points[keys[i].second];
      sum.position += p.weight * p.position;
      sum.height += p.weight * p.height;
      sum.weight += p.weight;
      sum.margin = std::min(sum.margin, p.margin);
    }
    if (sum.weight <= 0.0) continue;
    sum.position /= sum.weight;
    sum.height /= sum.weight;
    thinned.push_back(sum);
  }
  return thinned;
}

std::vector<VegetationPoint> thinToAtMost(const std::vector<VegetationPoint>& points,
                                          std::size_t count) {
  if (count < 4) throw UsageError("vegetation can be thinned to 4 points or more");
  if (points.size() <= count) return points;
  const Eigen::Vector2d extent = boxOf(points).sizes().cwiseMax(1e-3);
  // The squares that share the box evenly are too small or just right where the box is full; grow
  // them until they are few enough, then narrow the last step down.
  double small = 0.0;
  double large = std::max(std::sqrt(extent.prod() / static_cast<double>(count)),
                          0.1 * extent.maxCoeff() / static_cast<double>(count));
  if (Squares(points, large).occupied(points) <= count) {
    small = 0.1 * large;
  } else {
    do {
      small = large;
      large *= 1.3;
    } while (Squares(points, large).occupied(points) > count);
  }
  for (int i = 0; i < 6; ++i) {
    const double middle = 0.5 * (small + large);
    (Squares(points, middle).occupied(points) <= count ? large : small) = middle;
  }
  return thinVegetation(points, large);
}

}  // namespace agricolmap::map
