#include "agricolmap/pieces/bend.hpp"

#include <algorithm>
#include <utility>

#include "agricolmap/core/parallel.hpp"

namespace agricolmap::pieces {
namespace {

constexpr double kPathStep = 1.0;  // of the bent path [m]

Eigen::Vector2d leftOf(const Eigen::Vector2d& direction) { return {-direction.y(), direction.x()}; }

}  // namespace

Bend::Bend(deform::Path path, std::vector<BendNode> nodes)
    : path_(std::move(path)), nodes_(std::move(nodes)), slopes_(nodes_.size()) {
  // Of the parabola through a node and its neighbours; at the ends that of the chord.
  const auto chord = [&](std::size_t i) -> Eigen::Vector3d {
    return (nodes_[i + 1].shift - nodes_[i].shift) / (nodes_[i + 1].along - nodes_[i].along);
  };
  const std::size_t last = nodes_.size() - 1;
  for (std::size_t i = 1; i < last; ++i) {
    const double before = nodes_[i].along - nodes_[i - 1].along;
    const double behind = nodes_[i + 1].along - nodes_[i].along;
    slopes_[i] = (behind * chord(i - 1) + before * chord(i)) / (before + behind);
  }
  slopes_[0] = chord(0);
  slopes_[last] = chord(last - 1);
}

Bend::Motion Bend::at(double along) const {
  const auto behind =
      std::upper_bound(nodes_.begin() + 1, nodes_.end() - 1, along,
                       [](double value, const BendNode& node) { return value < node.along; });
  const auto i = static_cast<std::size_t>(behind - nodes_.begin()) - 1;
  const BendNode &a = nodes_[i], &b = nodes_[i + 1];
  const double length = b.along - a.along;
  const double t = (along - a.along) / length;
  if (t < 0.0) return {a.shift + (along - a.along) * slopes_[i], slopes_[i]};
  if (t > 1.0) return {b.shift + (along - b.along) * slopes_[i + 1], slopes_[i + 1]};
  const double t2 = t * t, t3 = t2 * t;
  return {(2.0 * t3 - 3.0 * t2 + 1.0) * a.shift + (3.0 * t2 - 2.0 * t3) * b.shift +
              length * ((t3 - 2.0 * t2 + t) * slopes_[i] + (t3 - t2) * slopes_[i + 1]),
          (6.0 * t2 - 6.0 * t) / length * (a.shift - b.shift) +
              (3.0 * t2 - 4.0 * t + 1.0) * slopes_[i] + (3.0 * t2 - 2.0 * t) * slopes_[i + 1]};
}

Eigen::Vector3d Bend::bent(const Eigen::Vector3d& point) const {
  const deform::PathPlace place = path_.place(point.head<2>());
  const Motion motion = at(place.along);
  const Eigen::Vector2d turned = (place.tangent + motion.slope.head<2>()).normalized();
  Eigen::Vector3d moved = point + motion.shift;
  moved.head<2>() += place.aside * (leftOf(turned) - leftOf(place.tangent));
  return moved;
}

deform::Path Bend::bentPath() const {
  std::vector<Eigen::Vector2d> corners;
  for (double along = 0.0; along < path_.length(); along += kPathStep) {
    corners.push_back(path_.point(along) + at(along).shift.head<2>());
  }
  corners.push_back(path_.point(path_.length()) + at(path_.length()).shift.head<2>());
  return deform::Path(corners);
}

Cloud bentCloud(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local, const Bend& bend) {
  Cloud bent = cloud;
  const Eigen::Affine3d back = levelled_from_local.inverse();
  constexpr std::size_t kChunk = 1U << 14;
  parallelFor((cloud.size() + kChunk - 1) / kChunk, [&](std::size_t chunk) {
    const std::size_t end = std::min(cloud.size(), (chunk + 1) * kChunk);
    for (std::size_t i = chunk * kChunk; i < end; ++i) {
      const Eigen::Vector3d point = levelled_from_local * cloud.xyz[i].cast<double>();
      bent.xyz[i] = (back * bend.bent(point)).cast<float>();
    }
  });
  return bent;
}

}  // namespace agricolmap::pieces
