// The knobs of the simulator. Artefacts follow the research notes §6.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/core/options.hpp"

namespace agricolmap {

/// The four data sets of the paper, and maize.
enum class Crop { kSoybean, kSugarBeet10m, kSugarBeet20m, kWinterWheat, kMaize };
std::vector<std::string> cropNames();

/// Layout of the field and build of its plants.
struct FieldOptions {
  double width = 20.0;               ///< east [m]
  double height = 20.0;              ///< north [m]
  double row_spacing = 0.5;          ///< [m]
  double plant_spacing = 0.18;       ///< within the row [m]
  double spacing_jitter = 0.15;      ///< deviation, share of the spacing
  double gaps = 0.06;                ///< share of plants missing, in clusters
  double row_wobble = 0.03;          ///< amplitude of the rows' slow meander [m]
  double row_heading_deg = -1.0;     ///< direction of the rows; negative: drawn from the seed
  double plant_height = 0.12;        ///< [m]
  double size_variation = 0.2;       ///< deviation of plant sizes, share
  double growth_gradient = 0.2;      ///< slow change of plant size over the field, share
  int leaves = 10;                   ///< per plant
  double leaf_length = 0.11;         ///< [m]
  double leaf_width = 0.05;          ///< [m]
  double leaf_elevation_deg = 45.0;  ///< at the stem
  double leaf_droop_deg = 60.0;      ///< lost towards the tip
  double weeds = 1.0;                ///< per m²
  double relief = 0.04;              ///< amplitude of slow relief [m]
  double furrow = 0.01;              ///< amplitude of ridges along the rows [m]
  double clods = 0.006;              ///< deviation of soil roughness [m]
  double tramline = 0.0;             ///< distance between wheel track pairs, 0: none [m]
};

/// What differs between the two views: fair views by default.
struct ViewOptions {
  double leaf_unshared = 0.5;  ///< share of leaves (and of soil texture) drawn anew for each view
  double wind = 0.01;          ///< deviation of a plant's sway at its top [m]
  double growth = 1.05;        ///< size of plants in the UGV's view over the UAV's
  double sun_hours = 1.0;      ///< time between the views: 15° of sun azimuth an hour
  double weeds_pulled = 0.0;   ///< share of weeds gone in the UGV's view
  double drift = 0.005;        ///< non-affine drift along the strip, share of its length
};

/// Photogrammetry from above.
struct UavOptions {
  double spacing = 0.014;     ///< distance of points [m]
  double smoothing = 0.03;    ///< deviation of the surface's smoothing [m]
  double canopy_gain = 0.8;   ///< height of canopy as reconstructed over its true height
  double noise = 0.006;       ///< deviation of heights, smooth over a few cells [m]
  double dome = 0.03;         ///< bulge of the block over the field [m]
  double holes = 0.01;        ///< share of the area without points
  double colour_noise = 4.0;  ///< deviation, 8-bit units
};

/// A strip seen obliquely from a ground robot.
struct UgvOptions {
  double length = 10.0;            ///< [m]
  double width = 2.2;              ///< [m]
  double spacing = 0.004;          ///< distance of points [m]
  double strip_heading_deg = 0.0;  ///< against the rows' direction
  double camera_height = 1.0;      ///< above the ground [m]
  double falloff = 0.5;            ///< share of points lost at the strip's sides
  double noise = 0.003;            ///< deviation of coordinates [m]
  double outliers = 0.002;         ///< share of flying points
  double holes = 0.02;             ///< share of the area without points
  double colour_noise = 5.0;       ///< deviation, 8-bit units
  double margin = 0.5;             ///< least distance of the strip from the field's border [m]
};

/// How wrong the initial guess is. Directions and signs are drawn independently.
struct GeotagOptions {
  double translation = 1.0;  ///< horizontal, at the strip's centre [m]
  double heading_deg = 2.0;  ///< [°]
  double scale = 0.05;       ///< of each horizontal axis of the UGV file, relative
  double vertical = 0.5;     ///< [m]
  double tilt_deg = 0.5;     ///< roll and pitch [°]
  bool uniform = false;      ///< draw magnitudes between 0 and these instead of exactly these
};

struct SimulationOptions {
  Crop crop = Crop::kSugarBeet10m;
  FieldOptions field;
  ViewOptions views;
  UavOptions uav;
  UgvOptions ugv;
  GeotagOptions geotag;
  int seed = 1;
  bool other_field = false;  ///< the strip comes from another field of the same settings
};
void describe(OptionTable& table, FieldOptions& options);
void describe(OptionTable& table, ViewOptions& options);
void describe(OptionTable& table, UavOptions& options);
void describe(OptionTable& table, UgvOptions& options);
void describe(OptionTable& table, GeotagOptions& options);
void describe(OptionTable& table, SimulationOptions& options);

/// Field, plants and sensors of one of the crops; fair views.
SimulationOptions cropPreset(Crop crop);

}  // namespace agricolmap
