// How far a transformation is from the truth.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "agricolmap/core/cloud.hpp"

namespace agricolmap::evaluate {

/// The paper's limits (Sec. V-A), with the project's on the points themselves.
struct SuccessLimits {
  double rms = 0.05;          ///< RMS displacement over the moving points [m]
  double translation = 0.05;  ///< e_t at the strip's centre [m]
  double rotation = 0.1;      ///< e_r [rad]
  double scale = 0.025;       ///< e_s over the two horizontal scales
};

struct RegistrationErrors {
  double rms = 0.0;             ///< RMS displacement over the moving points [m]
  double rms_horizontal = 0.0;  ///< its horizontal part [m]
  double rms_vertical = 0.0;    ///< its vertical part [m]
  double worst = 0.0;           ///< largest displacement of a point [m]
  /// Horizontal RMS between the estimate and the best affine over the moving points [m]: what is
  /// left when the part that no affine can follow (drift) is taken out.
  double rms_to_best_affine = 0.0;
  double translation = 0.0;  ///< the paper's e_t, at the centre of the moving points [m]
  double rotation = 0.0;     ///< the paper's e_r [rad]
  double scale = 0.0;        ///< the paper's e_s: norm of the relative errors of the two scales
  bool within(const SuccessLimits& limits) const {
    return rms <= limits.rms && translation <= limits.translation && rotation <= limits.rotation &&
           scale <= limits.scale;
  }
};

/// Where the moving points truly belong, in fixed file coordinates.
struct Truth {
  Eigen::Affine3d best_affine = Eigen::Affine3d::Identity();  ///< moving file → fixed file
  std::vector<Eigen::Vector3d> points;  ///< per moving point; empty: best_affine is exact
};

/// Errors of a cloud that was laid point by point: displacements alone, no transform's. `moving`:
/// its points before, of the same number.
RegistrationErrors evaluateAligned(const Cloud& aligned, const Truth& truth, const Cloud& moving);

/// Errors of `estimate` (moving file → fixed file) over all moving points.
RegistrationErrors evaluateTransform(const Eigen::Affine3d& estimate, const Truth& truth,
                                     const Cloud& moving);

}  // namespace agricolmap::evaluate
