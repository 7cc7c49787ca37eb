// Semi-real pairs: both views are cut from a real orthomosaic of a field, so that the layout of the
// plants, their gaps and their colours are real; sensors, drift and errors are simulated.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/raster.hpp"
#include "agricolmap/simulate/simulate.hpp"

namespace agricolmap::simulate {

/// A real orthomosaic. Row 0 is the southernmost. Rasters other than `colour` may be empty.
struct OrthoField {
  std::string name;          ///< for messages
  double gsd = 0.01;         ///< ground sampling distance [m]
  double row_heading = 0.0;  ///< direction of the plant rows from the raster's x axis [rad]
  /// South-west corner in projected coordinates [m]; nothing where the mosaic has none.
  std::optional<Eigen::Vector2d> corner;
  Raster<Rgb> colour;          ///< true colours: green plants
  Raster<std::uint8_t> valid;  ///< 0 = no data; empty: all valid
  Raster<float> height;        ///< surface [m]; empty: made up from greenness and simulated soil
  Raster<float> ground;        ///< terrain [m]; empty: from the lowest surface around
  std::vector<std::string> warnings;  ///< what its reader found odd, file named
};

class OrthoScene;

/// Like SimulatedField, on a real orthomosaic; see simulateFromOrtho.
class SimulatedOrtho {
 public:
  SimulatedOrtho(OrthoField field, const SimulationOptions& options);
  ~SimulatedOrtho();
  SimulatedOrtho(const SimulatedOrtho&) = delete;
  SimulatedOrtho& operator=(const SimulatedOrtho&) = delete;

  const Cloud& uav() const { return uav_; }
  Cloud takeUav() && { return std::move(uav_); }
  SimulatedStrip strip(const SimulationOptions& options, int index = 0) const;

 private:
  OrthoField field_;
  SimulationOptions options_;
  std::unique_ptr<const OrthoScene> scene_;  ///< looks at field_
  Cloud uav_;
};

/// Like simulatePair, with the layout of `field` in place of FieldOptions' (of which only the
/// relief of the soil and plant_size are used, where there is no height). The flight sees the
/// orthomosaic as it is. The drive sees it with `leaf_unshared` of the variance of its texture
/// below 3 cm replaced, moved by the wind, and lit from elsewhere; `growth` acts on heights,
/// `weeds_pulled` on nothing. For `other_field`, the strip is cut from the mosaic mirrored across
/// its rows. With GeotagOptions::utm, the UAV file has the mosaic's coordinates where it has any,
/// and heights as the surface model has them.
/// `beyond_map` is refused.
/// Throws InputError when the rasters do not fit each other or hold no valid place for the strip.
SimulatedPair simulateFromOrtho(const OrthoField& field, const SimulationOptions& options);

}  // namespace agricolmap::simulate
