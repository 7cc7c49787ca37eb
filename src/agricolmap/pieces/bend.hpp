// How a long strip is laid straight along its path before it is compared as a whole: what dead
// reckoning drifts by over tens of metres no single pose undoes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/deform/path.hpp"

namespace agricolmap::pieces {

/// Where a place on the path goes.
struct BendNode {
  double along = 0.0;                               ///< path length [m]
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< [m], the height last
};

/// A displacement of the moving levelled frame, smooth along the path. What lies beside the path
/// keeps its distance and turns with it.
class Bend {
 public:
  /// `nodes`: two or more, in order along the path, no two at one place. Between them a cubic with
  /// continuous slope, beyond them straight on.
  Bend(deform::Path path, std::vector<BendNode> nodes);

  /// Where a point of the moving levelled frame comes to lie, in the same frame [m].
  Eigen::Vector3d bent(const Eigen::Vector3d& point) const;
  /// The path itself as it comes to lie.
  deform::Path bentPath() const;

  const deform::Path& path() const { return path_; }
  const std::vector<BendNode>& nodes() const { return nodes_; }

 private:
  struct Motion {
    Eigen::Vector3d shift;
    Eigen::Vector3d slope;  ///< derivative along the path
  };
  Motion at(double along) const;

  deform::Path path_;
  std::vector<BendNode> nodes_;
  std::vector<Eigen::Vector3d> slopes_;  ///< at the nodes
};

/// The cloud with every point where the bend takes it; `levelled_from_local` leads to the levelled
/// frame.
Cloud bentCloud(const Cloud& cloud, const Eigen::Affine3d& levelled_from_local, const Bend& bend);

}  // namespace agricolmap::pieces
