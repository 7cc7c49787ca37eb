// Stage deform in the chain: the bend that blocks confirm is taken out of the strip, and what is
// left is measured and judged like any other strip.
#pragma once

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/deform/file_deformation.hpp"
#include "agricolmap/pipeline/judgement.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// Follows what bends the strip along `path` (levelled moving frame; nothing: straight through its
/// middle) and makes `placed` what is measured without it; leaves it as it is
/// where nothing is confirmed, or where the straightened strip fits no better.
void followBends(const refine::PairSignals& signals, const SearchSpace& space,
                 const std::optional<deform::Path>& path, const Refined& refined,
                 const RegistrationOptions& options, Monitor& monitor, Placed& placed);

/// What the deformation moves points by, in the coordinates of the files.
class Displacement {
 public:
  /// Of a registration with a transform and a bend that is followed, which must outlive this.
  explicit Displacement(const Registration& registration, const Cloud& moving);

  /// Of a point of the moving file, fixed file's axes [m]: it lies at fixed_from_moving · point +
  /// this.
  Eigen::Vector3d at(const Eigen::Vector3d& moving_point) const;
  /// Covariance of where a point of the moving file lies, what the strip's blocks may have in
  /// common included: fixed file's axes, x y z [m²].
  Eigen::Matrix3d covarianceAt(const Eigen::Vector3d& moving_point) const;
  /// The point of the moving file on the path at `along` [m], at the height of the ground.
  Eigen::Vector3d pathPoint(double along) const;

  /// Where a point of the moving file lies: transform and deformation, fixed file.
  Eigen::Vector3d place(const Eigen::Vector3d& moving_point) const;
  /// A direction of the levelled frame in the fixed file's axes.
  Eigen::Vector3d inFile(const Eigen::Vector3d& levelled) const;
  /// The function alone, which needs no registration to live on.
  const deform::FileDeformation& function() const { return function_; }

 private:
  const Registration& registration_;
  Eigen::Matrix3d file_from_levelled_;  ///< directions of the fixed frame
  deform::FileDeformation function_;
};

/// Where the registration puts every point of the moving cloud, in the fixed file's coordinates:
/// by its transform and, where there is one, its deformation.
Cloud alignedCloud(const Registration& registration, const Cloud& moving);

}  // namespace agricolmap::pipeline
