// Where a cloud's points go when it is written elsewhere.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <utility>

namespace agricolmap::io {

/// An affine and, where a strip is bent, a displacement on top of it. Many threads may ask at once.
struct PointMove {
  PointMove() = default;
  // What moves all points alike is a move, too.
  PointMove(const Eigen::Affine3d& affine)  // NOLINT(google-explicit-constructor)
      : target_from_file(affine) {}
  PointMove(const Eigen::Affine3d& affine,
            std::function<Eigen::Vector3d(const Eigen::Vector3d&)> further)
      : target_from_file(affine), displacement(std::move(further)) {}

  Eigen::Affine3d target_from_file = Eigen::Affine3d::Identity();
  /// Of a point of the file, in the target's axes [m]; empty: none.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> displacement;

  Eigen::Vector3d operator()(const Eigen::Vector3d& file_point) const {
    const Eigen::Vector3d moved = target_from_file * file_point;
    return displacement ? Eigen::Vector3d(moved + displacement(file_point)) : moved;
  }
};

}  // namespace agricolmap::io
