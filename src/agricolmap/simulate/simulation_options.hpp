// What a simulated pair of clouds looks like: the field, how the two views of it differ, the two
// sensors and the error of the initial guess. Sizes in metres unless named otherwise.
#pragma once

#include "agricolmap/core/options.hpp"

namespace agricolmap::simulate {

/// The crops of the paper's data set (Sec. IV-A) and maize, a tall one. "20m" is the beet field
/// flown at twice the height.
enum class Crop { kSoybean, kSugarBeet10m, kSugarBeet20m, kWinterWheat, kMaize };

/// What the soil shows beside its clods: things that do not grow, and that both views see.
struct SoilOptions {
  double contrast = 1.0;          ///< factor on the deviation of the soil's brightness
  double brightness = 1.0;        ///< factor on the soil's reflectance
  double tillage = 0.0;           ///< deviation of brightness of stripes along the rows, fraction
  double stones = 0.0;            ///< per m²
  double straw_brightness = 1.0;  ///< factor on the reflectance of straw
  double cover = 0.0;             ///< share of the soil under a flat green carpet: moss, seedlings
};
void listOptions(OptionTable& table, SoilOptions& options);

/// A trial: plots of a few rows, sown with varieties or crops of their own, bare soil between.
struct PlotOptions {
  double length = 0.0;  ///< of a plot along the rows, 0: rows without an end [m]
  double alley = 1.5;   ///< bare soil between plots along the rows [m]
  int rows = 4;         ///< of a plot
  int gap_rows = 0;     ///< rows left out between plots side by side
  double spread =
      0.0;  ///< deviation of size from plot to plant, fraction; twice of tone and ripeness
  double mixed = 0.0;  ///< share of plots sown with another crop
  /// Whether there are plots at all.
  bool any() const { return length > 0.0 || gap_rows > 0 || spread > 0.0 || mixed > 0.0; }
};
void listOptions(OptionTable& table, PlotOptions& options);

/// The field itself: where plants stand and what the soil is like.
struct FieldOptions {
  double width = 20.0;             ///< east–west extent of the UAV map [m]
  double height = 20.0;            ///< north–south extent of the UAV map [m]
  bool random_row_heading = true;  ///< rows in a random direction; else `row_heading_deg`
  double row_heading_deg = 0.0;    ///< direction of the rows from east, counter-clockwise [°]
  double row_spacing = 0.48;       ///< [m]
  double plant_spacing = 0.055;    ///< along the row [m]
  double plant_jitter = 0.25;      ///< deviation along the row, fraction of plant_spacing
  double lateral_jitter = 0.012;   ///< deviation across the row [m]
  bool synchronous = false;        ///< plants of all rows side by side, as sown by satellite
  double gaps = 0.06;              ///< fraction of plants missing
  double gap_length = 0.4;         ///< length of a cluster of missing plants [m]
  double row_wobble = 0.03;        ///< slow meandering of the rows, deviation [m]
  int pass_rows = 6;               ///< rows sown in one pass of the drill
  double pass_error = 0.02;        ///< deviation of the distance between passes [m]
  double tramline_spacing = 12.0;  ///< distance of wheel tracks, 0 = none [m]
  double weeds = 1.0;              ///< mean number of weeds per m², in patches
  double straw = 0.0;              ///< pieces of straw per m²
  double plant_size = 1.0;         ///< factor on the crop's usual plant size
  double size_spread = 0.18;       ///< deviation of plant size from plant to plant, fraction
  double growth_gradient = 0.15;   ///< deviation of plant size over ~6 m, fraction
  double tone_spread = 1.0;        ///< factor on the deviation of the plants' colours
  double relief = 0.02;            ///< deviation of the soil's height over `relief_length` [m]
  double relief_length = 5.0;      ///< distance over which the soil rises and falls [m]
  double slope = 0.01;             ///< slope of the field in a random direction
  double ridge = 0.006;            ///< half height of the ridges along the rows [m]
  double clods = 0.006;            ///< deviation of the soil's height over centimetres [m]
  double track_depth = 0.03;       ///< of wheel tracks; ruts where it is much [m]
  double terrace = 0.0;            ///< height of terraces, whose edges the rows cross [m]
  double terrace_length = 10.0;    ///< of a terrace along the rows [m]
  SoilOptions soil;
  PlotOptions plots;
};
void listOptions(OptionTable& table, FieldOptions& options);

/// What is different between the two visits.
struct ViewOptions {
  double leaf_unshared = 0.5;  ///< fraction of leaves and of fine soil texture drawn anew
  double soil_kept = 0.0;      ///< fraction of that soil texture that both views see nevertheless
  double soil_contrast = 1.0;  ///< contrast of the soil in the UGV view over that in the UAV view
  double wind = 0.01;          ///< deviation of a plant's top between the views [m]
  double lean_deg = 0.0;  ///< angle by which wind leans all plants, in each view its own way [°]
  double growth = 1.05;   ///< plant size in the UGV view over that in the UAV view
  double growth_spread = 0.0;  ///< deviation of that from plant to plant, fraction
  /// Of the crop in the UAV view: 0 green, 1 all leaves yellow, 2 all brown; between them the
  /// oldest are ahead.
  double ripeness = 0.0;
  double ripening = 0.0;      ///< more of it in the UGV view
  double sun_hour = 10.5;     ///< solar time of the flight [h]
  double sun_hours = 1.0;     ///< hours from the flight to the drive [h]
  double overcast = 0.3;      ///< share of light from the whole sky, 1 = no shadows
  double weeds_pulled = 0.0;  ///< fraction of the weeds gone in the UGV view
  double weeds_new = 0.0;     ///< fraction of the weeds that the UAV view does not have yet
  double plants_lost = 0.0;   ///< fraction of the crop's plants gone in the UGV view
};
void listOptions(OptionTable& table, ViewOptions& options);

/// From light to 8-bit colours. Each cloud draws its own response around these.
struct ColourOptions {
  double exposure = 1.0;        ///< factor on the automatic exposure
  double white_balance = 0.06;  ///< deviation of the red and blue gains
  double gamma_spread = 0.08;   ///< deviation of the tone curve's exponent
  double saturation = 1.0;      ///< 1 = as the scene, 0 = grey
  double gradient = 0.07;       ///< deviation of brightness over ~5 m (vignetting, clouds)
  double noise = 4.0;           ///< deviation per channel, 8-bit counts
};
void listOptions(OptionTable& table, ColourOptions& options);

/// The pieces that a drone's map is put together from, each of other pictures: polygons whose
/// centres are about `piece` apart. `truth` follows them, as what a piece shows is shown there.
struct MosaicOptions {
  double piece = 6.0;           ///< distance of the pieces [m]
  double shift = 0.0;           ///< deviation of a piece's place per axis [m]
  double shear = 0.0;           ///< deviation of its stretch, shear and turn, each
  double blur = 0.0;            ///< further blur of colours, each piece's from 0 to this [gsd]
  double exposure = 0.0;        ///< deviation of its brightness, fraction
  double doubled = 0.0;         ///< fraction of pieces that show everything twice
  double doubled_shift = 0.05;  ///< distance between the two [m]
  /// Whether the pieces differ in anything.
  bool any() const {
    return shift > 0.0 || shear > 0.0 || blur > 0.0 || exposure > 0.0 || doubled > 0.0;
  }
};
void listOptions(OptionTable& table, MosaicOptions& options);

/// The drone's cloud: seen from above, reconstructed from overlapping pictures.
struct UavOptions {
  double gsd = 0.014;               ///< ground sampling distance [m]
  double density = 1.0;             ///< points per gsd²
  double jitter = 0.5;              ///< random shift of a sample, fraction of gsd
  double smoothing = 0.03;          ///< Gaussian smoothing of heights, deviation [m]
  double colour_blur = 0.6;         ///< blur of colours, deviation in gsd
  double height_noise = 0.004;      ///< white noise of heights [m]
  double correlated_noise = 0.006;  ///< noise of heights over ~15 cm [m]
  double underestimate = 0.25;      ///< fraction of the canopy's height lost besides smoothing
  double dome = 0.04;               ///< height error of a corner against the centre [m]
  double holes = 0.01;              ///< fraction of the area without points
  /// Cells of what is sampled are at most so large, and two to a gsd at least [m]: a hectare takes
  /// gigabytes in fine ones.
  double canvas = 0.008;
  MosaicOptions mosaic;
  ColourOptions colour;
};
void listOptions(OptionTable& table, UavOptions& options);

/// The robot's cloud: a narrow strip seen by a forward-looking camera.
struct UgvOptions {
  double length = 10.0;        ///< of the strip [m]
  double width = 2.2;          ///< of the strip [m]
  double spacing = 0.004;      ///< between samples at the strip's middle [m]
  double heading_deg = 0.0;    ///< direction of travel against the rows [°]
  double overhang = 0.0;       ///< fraction of the strip beyond the UAV map's border
  double camera_height = 1.0;  ///< above the soil [m]
  double look_near = 0.4;      ///< nearest distance ahead that is mapped [m]
  double look_far = 1.6;       ///< farthest distance ahead that is mapped [m]
  double edge_density = 0.4;   ///< density at the strip's edges over that in its middle
  double smoothing = 0.005;    ///< Gaussian smoothing of heights, deviation [m]
  double noise = 0.003;        ///< noise along the viewing ray [m]
  double pose_noise = 0.003;   ///< shift of each camera position's points, deviation [m]
  double side_points = 0.25;   ///< share of steps in height that get points on their side
  double outliers = 0.002;     ///< fraction of flying points
  double drift = 0.005;        ///< largest drift of the path over its length
  /// There and back: twice the strip, the second time the other way round and beside the first.
  bool back = false;
  double back_aside = 2.0;  ///< of the second pass from the first, to the left [m]
  ColourOptions colour;
};
void listOptions(OptionTable& table, UgvOptions& options);

/// Error of the initial guess, see SimulatedPair::prior.
struct GeotagOptions {
  double translation = 1.0;     ///< horizontal error at the strip's centre [m]
  double heading_deg = 2.0;     ///< [°], random sign
  double scale = 0.05;          ///< on the UGV file's x and y axes, signs independent
  double z = 0.3;               ///< vertical error [m], random sign
  double vertical_scale = 0.0;  ///< on the UGV file's z axis, random sign
  double tilt_deg = 0.5;        ///< roll and pitch error [°], random signs
  double across_rows = 0.0;     ///< further error at the centre, across the rows, random sign [m]
  /// The UGV file's unit is unknown: all its lengths are divided by a factor between 1/this and
  /// this, log-uniform, of which the prior knows nothing. 1: metres.
  double unknown_scale = 1.0;
  bool uniform = false;           ///< magnitudes uniform from 0 to the values above
  double file_heading_deg = 0.0;  ///< true heading of the UGV file's x axis [°], known to the prior
  bool utm = true;                ///< UAV file in UTM coordinates, else from (0, 0, 0)
  bool ugv_georeferenced = false;  ///< UGV file in the UAV file's coordinates: identity prior
};
void listOptions(OptionTable& table, GeotagOptions& options);

struct SimulationOptions {
  Crop crop = Crop::kSoybean;
  FieldOptions field;
  ViewOptions views;
  UavOptions uav;
  UgvOptions ugv;
  GeotagOptions geotag;
  int seed = 1;
  // Strips that have no right place in the map:
  bool other_field = false;  ///< the strip comes from another field of the same settings
  bool beyond_map = false;   ///< it comes from a part of the field that the map does not show
  bool mirrored = false;     ///< its left is its right: the same rows, plants that lie nowhere
};
void listOptions(OptionTable& table, SimulationOptions& options);

/// Usual layouts and sensors for a crop.
SimulationOptions cropPreset(Crop crop);

}  // namespace agricolmap::simulate
