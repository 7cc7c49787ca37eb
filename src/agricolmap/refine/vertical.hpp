// Stage heights: the vertical part of the registration, once the plane is known. Tilt and offset
// come from the ground; canopy, which looks lower from above than from the side, must not bias
// them.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "agricolmap/core/options.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::refine {

struct VerticalOptions {
  double ground_window = 0.6;       ///< side of the window whose lowest cells are ground [m]
  double ground_tolerance = 0.015;  ///< height above the ground at which a cell stops to be it [m]
  double max_slope = 0.2;           ///< larger tilts between the levelled maps are refused
  double robust = 2.5;              ///< residuals beyond this many deviations do not count (Tukey)
};
void listOptions(OptionTable& table, VerticalOptions& options);

enum class VerticalStatus { kOk, kTooFewCells, kTooSteep };

/// fixed height = moving height + offset + slope · (p − about), p in the fixed levelled frame.
struct VerticalResult {
  VerticalStatus status = VerticalStatus::kTooFewCells;
  double offset = 0.0;                              ///< at `about` [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< [m/m]
  Eigen::Vector2d about = Eigen::Vector2d::Zero();  ///< middle of the overlap [m]
  double canopy_gain =
      1.0;                ///< how tall the fixed map sees what the moving map sees as 1 m of canopy
  double residual = 0.0;  ///< robust deviation of the ground cells from the model [m]
  std::size_t cells = 0;  ///< cells that both maps see
  double ground_share = 0.0;  ///< of these, the share that is ground in both maps
  /// By how much the offset would be another one if the maps' surfaces were one, and not their
  /// grounds, as far as the ground is hidden [m].
  double doubt = 0.0;

  /// Deviation of the height [m]: scatter of the ground, and the doubt what is ground.
  double deviation() const { return std::hypot(residual, doubt / std::numbers::sqrt2); }
};

/// Offset and tilt from the cells that are ground in both maps. A leaf over a cell lifts it in one
/// map more than in the other, by tens of centimetres in tall crops; where both see the soil, the
/// difference of heights is the registration's (simulated crops: within 2 cm). Under a canopy
/// without gaps, the lowest cells stand for the ground, and `ground_share` is small.
VerticalResult fitVertical(const map::GridMap& fixed, const map::GridMap& moving,
                           const Eigen::Affine2d& fixed_from_moving,
                           const VerticalOptions& options);

/// A horizontal pose, levelled moving → levelled fixed, with the vertical part found for it.
Eigen::Affine3d liftPose(const Eigen::Affine2d& pose, const VerticalResult& vertical);

}  // namespace agricolmap::refine
