#include "agricolmap/io/cloud/point_mover.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "agricolmap/io/cloud/block_move.hpp"
#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {
namespace {

/// Floats in steps of less are good enough for what a field is measured by [m].
constexpr double kFineStep = 1e-4;

Eigen::Vector3d mapped(const CoordinateMap* map, Eigen::Vector3d point) {
  if (map != nullptr) map->apply(&point[0], &point[1], &point[2], 1);
  return point;
}

/// How the map changes directions about a point of the file.
Eigen::Matrix3d directionsOf(const CoordinateMap* map, const Eigen::Vector3d& about) {
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity();
  if (map == nullptr) return directions;
  for (int axis = 0; axis < 3; ++axis) {
    // About a metre, whatever the unit is: of degrees the first try goes far too wide.
    double step = 1.0;
    for (const bool again : {false, true}) {
      const Eigen::Vector3d arm = step * Eigen::Vector3d::Unit(axis);
      const Eigen::Vector3d change = mapped(map, about + arm) - mapped(map, about - arm);
      if (!change.allFinite() || (!again && change.norm() > 100.0)) {
        step = 1e-5;
        continue;
      }
      directions.col(axis) = change / (2.0 * step);
      break;
    }
  }
  return directions;
}

}  // namespace

PointMover::PointMover(const CloudMove& move, const std::vector<Eigen::Vector3d>& samples)
    : move_(move) {
  const Eigen::Vector3d* first = nullptr;
  double far = 0.0;
  for (const Eigen::Vector3d& sample : samples) {
    if (!sample.allFinite()) continue;
    const Eigen::Vector3d point = mapped(move.map, sample);
    if (!((point - move.origin).cwiseAbs().maxCoeff() <= kMaxFromOrigin)) continue;
    if (first == nullptr) first = &sample;
    far = std::max(far, move.target_from_file(point).cwiseAbs().maxCoeff());
  }
  // Those that were not looked at may lie a little farther off.
  const auto value = static_cast<float>(1.1 * far);
  float_step_ = std::nextafter(value, std::numeric_limits<float>::infinity()) - value;
  const Eigen::Matrix3d directions =
      move.target_from_file.target_from_file.linear() *
      (first != nullptr ? directionsOf(move.map, *first) : Eigen::Matrix3d::Identity());
  turn_ = directions.inverse().transpose();
}

bool PointMover::needsDouble() const { return float_step_ > kFineStep; }

Eigen::Vector3d PointMover::turned(const Eigen::Vector3d& normal) const {
  const Eigen::Vector3d turned = turn_ * normal;
  const double length = turned.norm();
  return length > 0.0 && std::isfinite(length) ? Eigen::Vector3d(turned * (normal.norm() / length))
                                               : normal;
}

MoveTally PointMover::move(CoordinateBlock& block) const {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  MoveTally tally;
  auto& [x, y, z] = block.xyz;
  // What is not finite stays, and has nothing to do with maps.
  std::array<Eigen::Vector3d, CoordinateBlock::kCapacity> before;
  std::array<bool, CoordinateBlock::kCapacity> finite{};
  bool all = true;
  for (std::size_t i = 0; i < block.count; ++i) {
    finite[i] = std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i]);
    all = all && finite[i];
  }
  for (std::size_t i = 0; !all && i < block.count; ++i) {
    before[i] = block.point(i);
    if (!finite[i]) block.set(i, move_.origin);
  }
  if (move_.map != nullptr) move_.map->apply(x.data(), y.data(), z.data(), block.count);
  const Eigen::Vector3d origin = move_.origin;
  for (std::size_t i = 0; i < block.count; ++i) {
    const bool near = std::abs(x[i] - origin.x()) <= kMaxFromOrigin &&
                      std::abs(y[i] - origin.y()) <= kMaxFromOrigin &&
                      std::abs(z[i] - origin.z()) <= kMaxFromOrigin;
    tally.far += near || !finite[i] ? 0 : 1;
  }
  moveAll(move_.target_from_file, x.data(), y.data(), z.data(), block.count);
  for (std::size_t i = 0; i < block.count; ++i) {
    const bool somewhere = std::isfinite(x[i]) && std::isfinite(y[i]) && std::isfinite(z[i]);
    if (!finite[i]) {
      block.set(i, before[i]);
    } else if (!somewhere) {
      ++tally.nowhere;
      block.set(i, Eigen::Vector3d::Constant(kNone));
    }
  }
  return tally;
}

}  // namespace agricolmap::io
