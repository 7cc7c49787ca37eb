// Stage heights: the vertical part of the registration, once the plane is known. Tilt and offset
// come from the ground; canopy, which looks lower from above than from the side, must not bias
// them.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "agricolmap/core/options.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/refine/vertical_scale.hpp"

namespace agricolmap::refine {

enum class VerticalScaleKind { kAssumed, kMeasured };

struct VerticalOptions {
  /// Whether a vertical scale that the ground tells for sure is followed.
  VerticalScaleKind scale = VerticalScaleKind::kMeasured;
  double ground_window = 0.6;       ///< side of the window whose lowest cells are ground [m]
  double ground_tolerance = 0.015;  ///< height above the ground at which a cell stops to be it [m]
  double max_slope = 0.2;           ///< larger tilts between the levelled maps are refused
  double robust = 2.5;              ///< residuals beyond this many deviations do not count (Tukey)
};
void listOptions(OptionTable& table, VerticalOptions& options);

enum class VerticalStatus { kOk, kTooFewCells, kTooSteep };

/// fixed height = scale · moving height + offset + slope · (p − about), p in the fixed levelled
/// frame.
struct VerticalResult {
  VerticalStatus status = VerticalStatus::kTooFewCells;
  double scale = 1.0;  ///< 1 unless `measured_scale` is another one for sure
  VerticalScale measured_scale;
  double offset = 0.0;                              ///< at `about` [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< [m/m]
  Eigen::Vector2d about = Eigen::Vector2d::Zero();  ///< middle of the overlap [m]
  bool relief = false;                              ///< whether both maps have heights at all
  /// How tall the fixed map sees what the moving map sees as 1 m of canopy.
  double canopy_gain = 1.0;
  double canopy = 0.0;    ///< height over the moving map's ground that a tenth of the cells surpass
  double blur = 0.0;      ///< of the fixed surface against the moving one, deviation [m]
  double residual = 0.0;  ///< robust deviation of the ground cells from the model [m]
  std::size_t cells = 0;  ///< cells that both maps see
  double ground_share = 0.0;  ///< of these, the share that is low in both maps
  /// Of the lowest cells, the share that is ground: that has the colour of soil and not of plants,
  /// or, without colours that differ, as far as so many low cells that fit so well can be leaves.
  double ground_seen = 0.0;
  double lift = 0.0;  ///< by how much blurred plants lift the fixed map's ground, taken off [m]

  /// How wrong the offset may be for reasons that all cells have in common [m]: the lift that was
  /// taken off is known to a third, and lowest cells that are no ground may be as high above it as
  /// plants are.
  double bias() const;
  /// Deviation of the height [m]: the scatter of the ground, and the bias.
  double deviation() const { return std::hypot(residual, bias()); }
};

/// Offset and tilt from the cells that are low in both maps. A leaf over a cell lifts it in one map
/// more than in the other, by tens of centimetres in tall crops; where both see the soil, the
/// difference of heights is the registration's. Where gaps are narrow a drone's blur lifts them:
/// the robot's own surface, blurred as much, tells by how much (see CanopyLift), and the part of
/// that which the differences follow is taken off. Where the robot sees no ground either, nothing
/// tells, and `bias` says so.
VerticalResult fitVertical(const map::GridMap& fixed, const map::GridMap& moving,
                           const Eigen::Affine2d& fixed_from_moving,
                           const VerticalOptions& options);

/// A horizontal pose, levelled moving → levelled fixed, with the vertical part found for it.
Eigen::Affine3d liftPose(const Eigen::Affine2d& pose, const VerticalResult& vertical);

}  // namespace agricolmap::refine
