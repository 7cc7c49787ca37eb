#include "agricolmap/simulate/simulation_options.hpp"

namespace agricolmap::simulate {

void listOptions(OptionTable& t, SoilOptions& o) {
  t.number("contrast", o.contrast, 0.0, 5.0, "",
           "factor on the deviation of the soil's brightness");
  t.number("brightness", o.brightness, 0.2, 3.0, "", "factor on the soil's reflectance");
  t.number("tillage", o.tillage, 0.0, 1.0, "",
           "deviation of brightness of stripes along the rows, which both views see");
  t.number("stones", o.stones, 0.0, 500.0, "1/m2", "stones on the soil, which both views see");
  t.number("straw_brightness", o.straw_brightness, 0.2, 3.0, "",
           "factor on the reflectance of straw");
  t.number("cover", o.cover, 0.0, 1.0, "", "share of the soil under a flat green carpet");
}

void listOptions(OptionTable& t, PlotOptions& o) {
  t.number("length", o.length, 0.0, 200.0, "m",
           "length of trial plots along the rows, 0 for rows without an end");
  t.number("alley", o.alley, 0.0, 20.0, "m", "bare soil between plots along the rows");
  t.integer("rows", o.rows, 1, 1000, "", "rows of a plot");
  t.integer("gap_rows", o.gap_rows, 0, 100, "", "rows left out between plots side by side");
  t.number("spread", o.spread, 0.0, 1.0, "",
           "deviation of plant size from plot to plot; twice that of tone and ripeness");
  t.number("mixed", o.mixed, 0.0, 1.0, "", "share of plots sown with another crop");
}

void listOptions(OptionTable& t, FieldOptions& o) {
  t.number("width", o.width, 2.0, 200.0, "m", "east-west extent of the UAV map").basic();
  t.number("height", o.height, 2.0, 200.0, "m", "north-south extent of the UAV map").basic();
  t.flag("random_row_heading", o.random_row_heading, "rows in a random direction").basic();
  t.number("row_heading_deg", o.row_heading_deg, -360.0, 360.0, "deg",
           "direction of the rows from east, counter-clockwise, when not random")
      .basic();
  t.number("row_spacing", o.row_spacing, 0.08, 3.0, "m", "distance between rows");
  t.number("plant_spacing", o.plant_spacing, 0.01, 2.0, "m", "distance of plants along the row");
  t.number("plant_jitter", o.plant_jitter, 0.0, 2.0, "plant spacings",
           "deviation of a plant's place along the row");
  t.number("lateral_jitter", o.lateral_jitter, 0.0, 0.5, "m",
           "deviation of a plant's place across the row");
  t.flag("synchronous", o.synchronous, "plants of all rows side by side, as sown by satellite");
  t.number("gaps", o.gaps, 0.0, 1.0, "", "fraction of plants missing, in clusters").basic();
  t.number("gap_length", o.gap_length, 0.05, 10.0, "m", "length of a cluster of missing plants");
  t.number("row_wobble", o.row_wobble, 0.0, 1.0, "m", "deviation of the rows' slow meandering");
  t.integer("pass_rows", o.pass_rows, 1, 100, "", "rows sown in one pass of the drill");
  t.number("pass_error", o.pass_error, 0.0, 0.5, "m", "deviation of the distance between passes");
  t.number("tramline_spacing", o.tramline_spacing, 0.0, 100.0, "m",
           "distance between wheel tracks, 0 for none");
  t.number("weeds", o.weeds, 0.0, 100.0, "1/m2", "mean number of weeds, in patches").basic();
  t.number("straw", o.straw, 0.0, 500.0, "1/m2", "pieces of straw on the soil");
  t.number("plant_size", o.plant_size, 0.1, 5.0, "", "factor on the crop's usual plant size")
      .basic();
  t.number("size_spread", o.size_spread, 0.0, 1.0, "", "deviation of size from plant to plant");
  t.number("growth_gradient", o.growth_gradient, 0.0, 1.0, "",
           "deviation of plant size over about 6 m");
  t.number("tone_spread", o.tone_spread, 0.0, 5.0, "",
           "factor on the deviation of the plants' colours");
  t.number("relief", o.relief, 0.0, 1.0, "m", "deviation of the soil's height over relief_length");
  t.number("relief_length", o.relief_length, 0.5, 200.0, "m",
           "distance over which the soil rises and falls");
  t.number("slope", o.slope, 0.0, 0.3, "", "slope of the field, in a random direction");
  t.number("ridge", o.ridge, 0.0, 0.3, "m", "half height of the ridges along the rows");
  t.number("clods", o.clods, 0.0, 0.1, "m", "deviation of the soil's height over centimetres");
  t.number("track_depth", o.track_depth, 0.0, 0.5, "m", "depth of wheel tracks");
  t.number("terrace", o.terrace, 0.0, 2.0, "m",
           "height of terraces, whose edges the rows cross; 0 for none");
  t.number("terrace_length", o.terrace_length, 1.0, 200.0, "m",
           "length of a terrace along the rows");
  t.group("soil", o.soil);
  t.group("plots", o.plots);
}

void listOptions(OptionTable& t, ViewOptions& o) {
  t.number("leaf_unshared", o.leaf_unshared, 0.0, 1.0, "",
           "fraction of leaves and of fine soil texture that the views do not share")
      .basic();
  t.number("soil_kept", o.soil_kept, 0.0, 1.0, "",
           "fraction of that soil texture that both views see nevertheless");
  t.number("soil_contrast", o.soil_contrast, 0.0, 5.0, "",
           "contrast of the soil in the UGV view over the UAV view's");
  t.number("wind", o.wind, 0.0, 0.3, "m", "deviation of a plant's top between the views").basic();
  t.number("lean_deg", o.lean_deg, 0.0, 45.0, "deg",
           "angle by which wind leans all plants, in each view its own way");
  t.number("growth", o.growth, 0.3, 3.0, "", "plant size in the UGV view over the UAV view's")
      .basic();
  t.number("growth_spread", o.growth_spread, 0.0, 1.0, "",
           "deviation of growth from plant to plant");
  t.number("ripeness", o.ripeness, 0.0, 2.0, "",
           "of the crop in the UAV view: 0 green, 1 all leaves yellow, 2 all brown");
  t.number("ripening", o.ripening, -2.0, 2.0, "", "by how much the UGV view is riper");
  t.number("sun_hour", o.sun_hour, 6.0, 18.0, "h", "solar time of the flight");
  t.number("sun_hours", o.sun_hours, -8.0, 8.0, "h", "hours from the flight to the drive").basic();
  t.number("overcast", o.overcast, 0.0, 1.0, "", "share of light from the whole sky").basic();
  t.number("weeds_pulled", o.weeds_pulled, 0.0, 1.0, "", "fraction of weeds gone in the UGV view");
  t.number("weeds_new", o.weeds_new, 0.0, 1.0, "", "fraction of weeds not yet in the UAV view");
  t.number("plants_lost", o.plants_lost, 0.0, 1.0, "",
           "fraction of the crop's plants gone in the UGV view");
}

void listOptions(OptionTable& t, ColourOptions& o) {
  t.number("exposure", o.exposure, 0.1, 5.0, "", "factor on the automatic exposure");
  t.number("white_balance", o.white_balance, 0.0, 0.5, "", "deviation of red and blue gains");
  t.number("gamma_spread", o.gamma_spread, 0.0, 0.5, "", "deviation of the tone curve's exponent");
  t.number("saturation", o.saturation, 0.0, 3.0, "", "1 as the scene, 0 grey");
  t.number("gradient", o.gradient, 0.0, 0.5, "", "deviation of brightness over about 5 m");
  t.number("noise", o.noise, 0.0, 60.0, "counts", "deviation per channel");
}

void listOptions(OptionTable& t, MosaicOptions& o) {
  t.number("piece", o.piece, 1.0, 100.0, "m", "distance of the pieces' centres");
  t.number("shift", o.shift, 0.0, 1.0, "m", "deviation of a piece's place per axis");
  t.number("shear", o.shear, 0.0, 0.1, "", "deviation of a piece's stretch, shear and turn");
  t.number("blur", o.blur, 0.0, 10.0, "gsd", "further blur of colours, each piece's up to this");
  t.number("exposure", o.exposure, 0.0, 0.5, "", "deviation of a piece's brightness");
  t.number("doubled", o.doubled, 0.0, 1.0, "", "fraction of pieces that show everything twice");
  t.number("doubled_shift", o.doubled_shift, 0.0, 1.0, "m", "distance between the two");
}

void listOptions(OptionTable& t, UavOptions& o) {
  t.number("gsd", o.gsd, 0.004, 0.2, "m", "ground sampling distance").basic();
  t.number("density", o.density, 0.01, 4.0, "1/gsd2", "points per squared sampling distance")
      .basic();
  t.number("jitter", o.jitter, 0.0, 2.0, "gsd", "random shift of a sample");
  t.number("smoothing", o.smoothing, 0.0, 0.5, "m", "Gaussian smoothing of heights, deviation");
  t.number("colour_blur", o.colour_blur, 0.0, 10.0, "gsd", "blur of colours, deviation");
  t.number("height_noise", o.height_noise, 0.0, 0.2, "m", "white noise of heights");
  t.number("correlated_noise", o.correlated_noise, 0.0, 0.2, "m", "noise of heights over 15 cm");
  t.number("underestimate", o.underestimate, 0.0, 1.0, "",
           "fraction of the canopy's height lost besides smoothing");
  t.number("dome", o.dome, -1.0, 1.0, "m", "height error of a corner against the centre");
  t.number("holes", o.holes, 0.0, 0.5, "", "fraction of the area without points").basic();
  t.number("canvas", o.canvas, 0.004, 0.1, "m",
           "largest cell of what is sampled, two to a sampling distance at least");
  t.group("mosaic", o.mosaic);
  t.group("colour", o.colour);
}

void listOptions(OptionTable& t, UgvOptions& o) {
  t.number("length", o.length, 0.5, 200.0, "m", "length of the strip").basic();
  t.number("width", o.width, 0.2, 10.0, "m", "width of the strip").basic();
  t.number("spacing", o.spacing, 0.002, 0.05, "m", "distance of samples at the strip's middle")
      .basic();
  t.number("heading_deg", o.heading_deg, -360.0, 360.0, "deg", "direction against the rows");
  t.number("overhang", o.overhang, 0.0, 0.9, "", "fraction of the strip beyond the UAV map")
      .basic();
  t.number("camera_height", o.camera_height, 0.2, 5.0, "m", "height of the camera above the soil")
      .basic();
  t.number("look_near", o.look_near, 0.0, 5.0, "m", "nearest distance ahead that is mapped");
  t.number("look_far", o.look_far, 0.1, 10.0, "m", "farthest distance ahead that is mapped");
  t.number("edge_density", o.edge_density, 0.01, 1.0, "", "density at the edges over the middle's");
  t.number("smoothing", o.smoothing, 0.0, 0.1, "m", "Gaussian smoothing of heights, deviation");
  t.number("noise", o.noise, 0.0, 0.1, "m", "noise along the viewing ray");
  t.number("pose_noise", o.pose_noise, 0.0, 0.1, "m", "shift of each camera position's points");
  t.number("side_points", o.side_points, 0.0, 1.0, "",
           "share of steps in height with points on their side");
  t.number("outliers", o.outliers, 0.0, 0.2, "", "fraction of flying points");
  t.number("drift", o.drift, 0.0, 0.1, "", "largest drift of the path over its length").basic();
  t.flag("back", o.back, "drive back beside the strip, too, in the same file");
  t.number("back_aside", o.back_aside, -20.0, 20.0, "m",
           "the way back from the way there, to the left");
  t.group("colour", o.colour);
}

void listOptions(OptionTable& t, GeotagOptions& o) {
  t.number("translation", o.translation, 0.0, 1000.0, "m", "horizontal error at the centre")
      .basic();
  t.number("heading_deg", o.heading_deg, 0.0, 180.0, "deg", "heading error, random sign").basic();
  t.number("scale", o.scale, 0.0, 0.9, "", "scale error per horizontal axis, random signs").basic();
  t.number("z", o.z, 0.0, 100.0, "m", "vertical error, random sign");
  t.number("vertical_scale", o.vertical_scale, 0.0, 0.9, "", "vertical scale error, random sign");
  t.number("tilt_deg", o.tilt_deg, 0.0, 30.0, "deg", "roll and pitch error, random signs");
  t.number("across_rows", o.across_rows, 0.0, 100.0, "m",
           "further error at the centre, across the rows, random sign");
  t.number("unknown_scale", o.unknown_scale, 1.0, 100.0, "",
           "UGV file in an unknown unit: lengths divided by a factor from 1/this to this")
      .basic();
  t.flag("uniform", o.uniform, "errors uniform from zero to the values given");
  t.number("file_heading_deg", o.file_heading_deg, -360.0, 360.0, "deg",
           "heading of the UGV file's x axis, known to the prior");
  t.flag("utm", o.utm, "UAV file in UTM coordinates").basic();
  t.flag("ugv_georeferenced", o.ugv_georeferenced,
         "UGV file in the UAV file's coordinates, prior is the identity");
}

void listOptions(OptionTable& t, SimulationOptions& o) {
  t.choice("crop", o.crop, {"soybean", "sugar_beet_10m", "sugar_beet_20m", "winter_wheat", "maize"},
           "kind of plants")
      .basic();
  t.group("field", o.field, "the field");
  t.group("views", o.views, "how the two views differ");
  t.group("uav", o.uav, "the drone's cloud");
  t.group("ugv", o.ugv, "the robot's cloud");
  t.group("geotag", o.geotag, "the error of the initial guess");
  t.integer("seed", o.seed, 0, 2147483647, "", "what everything random follows from").basic();
  t.flag("other_field", o.other_field, "take the strip from another field: nothing to find")
      .basic();
  t.flag("beyond_map", o.beyond_map, "take the strip from beyond the UAV map: nothing to find")
      .basic();
  t.flag("mirrored", o.mirrored, "swap the strip's left and right: nothing to find").basic();
}

namespace {

void beetPreset(SimulationOptions& o) {
  o.field.row_spacing = 0.50;
  o.field.plant_spacing = 0.19;
  o.field.plant_jitter = 0.15;
  o.field.size_spread = 0.25;
  o.field.gaps = 0.10;
  o.field.weeds = 2.0;
}

void wheatPreset(SimulationOptions& o) {
  o.field.row_spacing = 0.125;
  o.field.plant_spacing = 0.036;
  o.field.plant_jitter = 0.4;
  o.field.lateral_jitter = 0.008;
  o.field.gaps = 0.08;
  o.field.gap_length = 0.25;
  o.field.row_wobble = 0.02;
  o.field.pass_rows = 24;
  o.field.ridge = 0.003;
  o.field.weeds = 0.5;
}

void maizePreset(SimulationOptions& o) {
  o.field.row_spacing = 0.75;
  o.field.plant_spacing = 0.16;
  o.field.plant_jitter = 0.15;
  o.field.lateral_jitter = 0.015;
  o.field.pass_rows = 4;
  o.ugv.camera_height = 1.6;
}

}  // namespace

SimulationOptions cropPreset(Crop crop) {
  SimulationOptions o;
  o.crop = crop;
  switch (crop) {
    case Crop::kSoybean:
      o.field.straw = 40.0;
      break;
    case Crop::kSugarBeet10m:
      beetPreset(o);
      break;
    case Crop::kSugarBeet20m:
      beetPreset(o);
      o.uav.gsd = 0.028;
      o.uav.smoothing = 0.045;
      break;
    case Crop::kWinterWheat:
      wheatPreset(o);
      break;
    case Crop::kMaize:
      maizePreset(o);
      break;
  }
  return o;
}

}  // namespace agricolmap::simulate
