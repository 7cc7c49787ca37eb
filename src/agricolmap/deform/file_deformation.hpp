// A deformation as a function of places in the coordinates of the files, with all that it takes to
// make the same function again elsewhere.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "agricolmap/deform/deformation.hpp"

namespace agricolmap::deform {

/// Made for asking it of every point of large clouds: the spline is kept as polynomials.
class FileDeformation {
 public:
  /// `levelled_from_moving`: moving file → levelled moving frame. `fixed_from_displacement`: what
  /// the deformation says, fixed levelled frame → fixed file's axes, through the pose that comes
  /// behind it.
  FileDeformation(Deformation deformation, const Eigen::Affine3d& levelled_from_moving,
                  const Eigen::Matrix3d& fixed_from_displacement);

  /// Displacement of a point of the moving file, fixed file's axes [m].
  Eigen::Vector3d at(const Eigen::Vector3d& moving_point) const;

  const Deformation& deformation() const { return deformation_; }
  const Eigen::Affine3d& levelledFromMoving() const { return levelled_from_moving_; }
  const Eigen::Matrix3d& fixedFromDisplacement() const { return fixed_from_displacement_; }

 private:
  /// Of a span, in the share of it that lies behind: coefficients of 1, u, u² and u³.
  struct Span {
    Eigen::Vector3d c0, c1, c2, c3;
  };

  Deformation deformation_;
  Eigen::Affine3d levelled_from_moving_;
  Eigen::Matrix3d fixed_from_displacement_;
  double per_metre_;  ///< spans
  std::vector<Span> spans_;
};

}  // namespace agricolmap::deform
