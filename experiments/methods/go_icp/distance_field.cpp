#include "experiments/methods/go_icp/distance_field.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::experiments {
namespace {

constexpr float kFar = 1e12F;

/// Squared distances along one line (Felzenszwalb & Huttenlocher 2012): the lower envelope of the
/// parabolas that stand at each element. `n` elements, `hull` and `bounds` as scratch.
void transformLine(std::vector<float>& line, int n, std::vector<int>& hull,
                   std::vector<float>& bounds, std::vector<float>& result) {
  int last = -1;
  for (int q = 0; q < n; ++q) {
    const float f = line[static_cast<std::size_t>(q)];
    if (f >= kFar) continue;
    float start = -kFar;
    while (last >= 0) {
      const int p = hull[static_cast<std::size_t>(last)];
      start = ((f + static_cast<float>(q * q)) -
               (line[static_cast<std::size_t>(p)] + static_cast<float>(p * p))) /
              static_cast<float>(2 * (q - p));
      if (start > bounds[static_cast<std::size_t>(last)]) break;
      --last;
      start = -kFar;
    }
    ++last;
    hull[static_cast<std::size_t>(last)] = q;
    bounds[static_cast<std::size_t>(last)] = start;
  }
  if (last < 0) return;
  int k = 0;
  for (int q = 0; q < n; ++q) {
    while (k < last && bounds[static_cast<std::size_t>(k + 1)] < static_cast<float>(q)) ++k;
    const int p = hull[static_cast<std::size_t>(k)];
    result[static_cast<std::size_t>(q)] =
        line[static_cast<std::size_t>(p)] + static_cast<float>((q - p) * (q - p));
  }
  std::copy_n(result.begin(), n, line.begin());
}

}  // namespace

DistanceField::DistanceField(const std::vector<Eigen::Vector3d>& points, double cell, double margin)
    : cell_(static_cast<float>(cell)) {
  Eigen::Vector3d low = points.front();
  Eigen::Vector3d high = points.front();
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  low.array() -= margin;
  high.array() += margin;
  low_ = low.cast<float>();
  for (int k = 0; k < 3; ++k) {
    size_[k] = static_cast<int>(std::ceil((high[k] - low[k]) / cell)) + 1;
    high_[k] = low_[k] + cell_ * (static_cast<float>(size_[k]) - 0.01F);
  }
  distance_.assign(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()) *
                       static_cast<std::size_t>(size_.z()),
                   kFar);
  for (const Eigen::Vector3d& p : points) {
    distance_[offset(((p - low) / cell).array().floor().cast<int>().matrix())] = 0.0F;
  }
  for (int axis = 0; axis < 3; ++axis) transformAxis(axis);
  for (float& d : distance_) d = cell_ * std::sqrt(d);
}

void DistanceField::transformAxis(int axis) {
  const int n = size_[axis];
  const int first = (axis + 1) % 3;
  const int second = (axis + 2) % 3;
  parallelFor(static_cast<std::size_t>(size_[first]), [&](std::size_t a) {
    std::vector<float> line(static_cast<std::size_t>(n));
    std::vector<float> result(line.size());
    std::vector<float> bounds(line.size() + 1);
    std::vector<int> hull(line.size());
    Eigen::Vector3i index;
    index[first] = static_cast<int>(a);
    for (index[second] = 0; index[second] < size_[second]; ++index[second]) {
      for (index[axis] = 0; index[axis] < n; ++index[axis]) {
        line[static_cast<std::size_t>(index[axis])] = distance_[offset(index)];
      }
      transformLine(line, n, hull, bounds, result);
      for (index[axis] = 0; index[axis] < n; ++index[axis]) {
        distance_[offset(index)] = line[static_cast<std::size_t>(index[axis])];
      }
    }
  });
}

}  // namespace agricolmap::experiments
