// Bare soil between the plants as a witness of its own. Plants grow, lean in the wind and hide
// their far sides from a camera that looks ahead, all of them alike: a pose that lays plants upon
// plants follows them. Clods, stones and straw lie where they lay, and as small as they are they
// tell a place to millimetres where both views see them.
#pragma once

#include <Eigen/Geometry>
#include <optional>

#include "agricolmap/core/options.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::refine {

struct SoilPoseOptions {
  bool follow = true;
  double wave = 0.15;    ///< luminance is compared up to this wavelength: shadows are larger [m]
  double bare = 0.3;     ///< bare soil: below this share of the way from soil to plant
  double margin = 0.04;  ///< how far from a plant it begins [m]
  double reach = 0.24;   ///< how far plants may have leant [m]
  double share = 0.07;   ///< of the strip must be bare in both maps
  double agree = 0.42;   ///< correlation of the soil from which on more than shadows is shared
  double clear = 6.0;    ///< deviations above chance from which on its place is believed
};
void listOptions(OptionTable& table, SoilPoseOptions& options);

struct SoilWitness {
  double share = 0.0;  ///< of the moving map's cells: bare soil in both maps
  /// Correlation of its luminance over what is usual at other shifts, in their deviations: the
  /// highest within reach, and where the plants lie upon one another.
  double peak = 0.0;
  double at_plants = 0.0;
  double correlation = 0.0;             ///< at the peak
  std::optional<Eigen::Affine2d> pose;  ///< the moving map's by the soil; nothing unless clear
};

/// Looks for the soil's place around `plants`, the pose so far; levelled frames, `fixed` what lies
/// around there. `factor`: grid cells a cell. Nothing is clear where hardly any soil is bare, where
/// it was tilled between the views, or where clouds are too coarse to show clods.
SoilWitness askSoil(const map::GridMap& fixed, const map::GridMap& moving,
                    const Eigen::Affine2d& plants, int factor, const SoilPoseOptions& options);

/// What plants and soil say together: the mean of their poses, which has less of the errors of
/// each; where the soil contradicts the plants its own, for it neither grows nor leans; the plants'
/// where the soil says nothing.
Eigen::Affine2d heardTogether(const Eigen::Affine2d& plants, const SoilWitness& soil);

}  // namespace agricolmap::refine
