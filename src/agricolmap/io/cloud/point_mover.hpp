// Moves coordinates and normals by the block, however their file keeps them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "agricolmap/io/cloud/cloud_move.hpp"

namespace agricolmap::io {

/// Coordinates of a few points, by axis.
struct CoordinateBlock {
  static constexpr std::size_t kCapacity = 512;
  std::size_t count = 0;
  std::array<std::array<double, kCapacity>, 3> xyz;

  Eigen::Vector3d point(std::size_t i) const { return {xyz[0][i], xyz[1][i], xyz[2][i]}; }
  void set(std::size_t i, const Eigen::Vector3d& point) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      xyz[axis][i] = point[static_cast<Eigen::Index>(axis)];
    }
  }
};

/// What became of points.
struct MoveTally {
  std::uint64_t nowhere = 0;  ///< finite before, but not after
  std::uint64_t far = 0;      ///< from where the move belongs
  MoveTally& operator+=(const MoveTally& other) {
    nowhere += other.nowhere;
    far += other.far;
    return *this;
  }
};

class PointMover {
 public:
  /// `samples`: some points of the file. Both must outlive it.
  PointMover(const CloudMove& move, const std::vector<Eigen::Vector3d>& samples);

  /// Moves points in place. Those that are not finite stay as they are.
  MoveTally move(CoordinateBlock& block) const;
  /// A normal, turned as the whole is: by the transform and the change of projection, without what
  /// a bend turns it by. Its length stays.
  Eigen::Vector3d turned(const Eigen::Vector3d& normal) const;
  /// Where 32-bit floats are too coarse for where the points come to lie: their steps there [m].
  double floatStep() const { return float_step_; }
  bool needsDouble() const;

 private:
  const CloudMove& move_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();
  double float_step_ = 0.0;
};

}  // namespace agricolmap::io
