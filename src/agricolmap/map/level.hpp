// Stage level (paper Sec. II): level a cloud by its ground plane, so that "height" means height
// above the field.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/options.hpp"
#include "agricolmap/core/point_stream.hpp"

namespace agricolmap::map {

struct LevelOptions {
  double cell = 0.5;           ///< side of the cells whose low points stand for the ground [m]
  double percentile = 0.1;     ///< which of a cell's heights is taken for its ground
  double max_tilt_deg = 45.0;  ///< steeper planes are no field [°]
};
void listOptions(OptionTable& table, LevelOptions& options);

/// A cloud's ground and the frame in which it is level.
struct Levelling {
  /// Rigid: local coordinates after the initial guess → levelled frame. The ground plane becomes
  /// z = 0; x and y of the cloud's middle stay where they were.
  Eigen::Affine3d levelled_from_guess = Eigen::Affine3d::Identity();
  double tilt = 0.0;       ///< angle between the ground's normal and z before levelling [rad]
  double roughness = 0.0;  ///< robust deviation of the ground cells from the plane [m]
  std::size_t cells = 0;   ///< cells with points enough
  /// A canopy hides the ground from many cells, or there is relief; the plane is the lowest that
  /// enough of the cells support, and `roughness` of those close to it and of those below.
  bool under_canopy = false;
  double support = 1.0;  ///< share of the cells that are within centimetres of such a plane
};

/// Fits the ground plane of `cloud` in the frame `guess_from_local` and levels it, by points spread
/// over it; one pass.
/// Throws InputError for clouds without extent (one point, all points in one place, a line) and for
/// planes steeper than `max_tilt_deg`.
Levelling levelCloud(const PointStream& cloud, const Eigen::Affine3d& guess_from_local,
                     const LevelOptions& options);
Levelling levelCloud(const Cloud& cloud, const Eigen::Affine3d& guess_from_local,
                     const LevelOptions& options);

}  // namespace agricolmap::map
