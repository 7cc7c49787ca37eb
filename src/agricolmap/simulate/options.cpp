#include "agricolmap/simulate/options.hpp"

namespace agricolmap {

std::vector<std::string> cropNames() {
  return {"soybean", "sugar-beet-10m", "sugar-beet-20m", "winter-wheat", "maize"};
}

void describe(OptionTable& table, FieldOptions& o) {
  table.number("width", o.width, 2, 1000, "m", "extent to the east");
  table.number("height", o.height, 2, 1000, "m", "extent to the north");
  table.number("row_spacing", o.row_spacing, 0.05, 5, "m", "distance of the rows");
  table.number("plant_spacing", o.plant_spacing, 0.01, 5, "m", "distance of plants in a row");
  table.number("spacing_jitter", o.spacing_jitter, 0, 1, "", "its deviation, relative");
  table.number("gaps", o.gaps, 0, 0.95, "", "share of plants missing, in clusters");
  table.number("row_wobble", o.row_wobble, 0, 1, "m", "amplitude of the rows' meander");
  table.number("row_heading_deg", o.row_heading_deg, -1, 360, "deg",
               "direction of the rows from east; negative: drawn from the seed");
  table.number("plant_height", o.plant_height, 0.01, 3, "m", "height of the plants");
  table.number("size_variation", o.size_variation, 0, 1, "", "deviation of plant sizes, relative");
  table.number("growth_gradient", o.growth_gradient, 0, 1, "", "slow change of sizes, relative");
  table.integer("leaves", o.leaves, 1, 100, "", "leaves of a plant");
  table.number("leaf_length", o.leaf_length, 0.005, 2, "m", "length of a leaf");
  table.number("leaf_width", o.leaf_width, 0.002, 1, "m", "width of a leaf");
  table.number("leaf_elevation_deg", o.leaf_elevation_deg, -30, 90, "deg", "rise at the stem");
  table.number("leaf_droop_deg", o.leaf_droop_deg, 0, 180, "deg", "rise lost towards the tip");
  table.number("weeds", o.weeds, 0, 1000, "1/m2", "weeds");
  table.number("relief", o.relief, 0, 5, "m", "amplitude of slow relief");
  table.number("furrow", o.furrow, 0, 1, "m", "amplitude of ridges along the rows");
  table.number("clods", o.clods, 0, 0.2, "m", "deviation of soil roughness");
  table.number("tramline", o.tramline, 0, 100, "m", "distance of wheel-track pairs; 0: none");
}

void describe(OptionTable& table, ViewOptions& o) {
  table.number("leaf_unshared", o.leaf_unshared, 0, 1, "",
               "share of leaves and soil texture drawn anew for each view");
  table.number("wind", o.wind, 0, 1, "m", "deviation of a plant's sway at its top");
  table.number("growth", o.growth, 0.2, 5, "", "size of plants in the UGV's view over the UAV's");
  table.number("sun_hours", o.sun_hours, -12, 12, "h", "time between the views");
  table.number("weeds_pulled", o.weeds_pulled, 0, 1, "", "share of weeds gone in the UGV's view");
  table.number("drift", o.drift, 0, 0.2, "", "non-affine drift, share of the strip's length");
}

void describe(OptionTable& table, UavOptions& o) {
  table.number("spacing", o.spacing, 0.002, 1, "m", "distance of points");
  table.number("smoothing", o.smoothing, 0, 1, "m", "deviation of the surface's smoothing");
  table.number("canopy_gain", o.canopy_gain, 0, 2, "", "reconstructed over true canopy height");
  table.number("noise", o.noise, 0, 1, "m", "deviation of heights");
  table.number("dome", o.dome, -5, 5, "m", "bulge of the block over the field");
  table.number("holes", o.holes, 0, 0.9, "", "share of the area without points");
  table.number("colour_noise", o.colour_noise, 0, 100, "1/255", "deviation of colours");
}

void describe(OptionTable& table, UgvOptions& o) {
  table.number("length", o.length, 0.5, 1000, "m", "of the strip");
  table.number("width", o.width, 0.3, 1000, "m", "of the strip");
  table.number("spacing", o.spacing, 0.001, 1, "m", "distance of points");
  table.number("strip_heading_deg", o.strip_heading_deg, -360, 360, "deg",
               "of the strip against the rows");
  table.number("camera_height", o.camera_height, 0.1, 10, "m", "above the ground");
  table.number("falloff", o.falloff, 0, 1, "", "share of points lost at the strip's sides");
  table.number("noise", o.noise, 0, 1, "m", "deviation of coordinates");
  table.number("outliers", o.outliers, 0, 0.5, "", "share of flying points");
  table.number("holes", o.holes, 0, 0.9, "", "share of the area without points");
  table.number("colour_noise", o.colour_noise, 0, 100, "1/255", "deviation of colours");
  table.number("margin", o.margin, -100, 100, "m",
               "least distance of the strip from the field's border; negative: it may reach over");
}

void describe(OptionTable& table, GeotagOptions& o) {
  table.number("translation", o.translation, 0, 1000, "m",
               "horizontal error at the strip's centre");
  table.number("heading_deg", o.heading_deg, 0, 180, "deg", "heading error");
  table.number("scale", o.scale, 0, 0.6, "", "scale error of each horizontal axis, relative");
  table.number("vertical", o.vertical, 0, 1000, "m", "vertical error");
  table.number("tilt_deg", o.tilt_deg, 0, 30, "deg", "roll and pitch error");
  table.flag("uniform", o.uniform, "draw errors between zero and these instead of exactly these");
}

void describe(OptionTable& table, SimulationOptions& o) {
  table.choice("crop", o.crop, cropNames(), "which crop the presets are for");
  table.group("field", o.field);
  table.group("views", o.views);
  table.group("uav", o.uav);
  table.group("ugv", o.ugv);
  table.group("geotag", o.geotag);
  table.integer("seed", o.seed, 0, 2'000'000'000, "", "of everything random");
  table.flag("other_field", o.other_field, "take the strip from another field: nothing overlaps");
}

SimulationOptions cropPreset(Crop crop) {
  SimulationOptions o;
  o.crop = crop;
  FieldOptions& f = o.field;
  switch (crop) {
    case Crop::kSoybean:
      f.row_spacing = 0.45;
      f.plant_spacing = 0.06;
      f.spacing_jitter = 0.35;
      f.plant_height = 0.13;
      f.leaves = 9;
      f.leaf_length = 0.06;
      f.leaf_width = 0.04;
      f.leaf_elevation_deg = 55.0;
      f.leaf_droop_deg = 60.0;
      break;
    case Crop::kSugarBeet10m:
      break;
    case Crop::kSugarBeet20m:
      o.uav.spacing = 0.02;
      o.uav.smoothing = 0.045;
      o.uav.noise = 0.01;
      break;
    case Crop::kWinterWheat:
      f.row_spacing = 0.125;
      f.plant_spacing = 0.025;
      f.spacing_jitter = 0.4;
      f.gaps = 0.1;
      f.row_wobble = 0.015;
      f.plant_height = 0.25;
      f.leaves = 4;
      f.leaf_length = 0.22;
      f.leaf_width = 0.009;
      f.leaf_elevation_deg = 80.0;
      f.leaf_droop_deg = 90.0;
      f.weeds = 0.3;
      f.furrow = 0.004;
      f.tramline = 6.0;
      o.uav.canopy_gain = 0.75;
      break;
    case Crop::kMaize:
      f.row_spacing = 0.75;
      f.plant_spacing = 0.16;
      f.spacing_jitter = 0.12;
      f.plant_height = 0.8;
      f.leaves = 9;
      f.leaf_length = 0.55;
      f.leaf_width = 0.06;
      f.leaf_elevation_deg = 65.0;
      f.leaf_droop_deg = 110.0;
      f.furrow = 0.02;
      o.uav.canopy_gain = 0.7;
      o.ugv.camera_height = 1.8;
      break;
  }
  return o;
}

}  // namespace agricolmap
