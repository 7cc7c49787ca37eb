#include "experiments/pairs/views.hpp"

namespace agricolmap::experiments {
namespace {

/// One option's values, for either half by turns: both span the same, neither has the other's.
struct Drawn {
  const char* path;
  std::vector<double> develop;
  std::vector<double> final;
};

/// Of any sensor, and of the robot's path.
const std::vector<Drawn>& sensorSettings() {
  static const std::vector<Drawn> all = {{"ugv.colour.exposure", {0.75, 1.15}, {0.9, 1.4}},
                                         {"ugv.colour.white_balance", {0.05, 0.15}, {0.10, 0.20}},
                                         {"ugv.colour.gamma_spread", {0.05, 0.15}, {0.10, 0.20}},
                                         {"ugv.colour.saturation", {0.8, 1.1}, {0.7, 1.0, 1.3}},
                                         {"ugv.colour.gradient", {0.05, 0.12}, {0.09, 0.16}},
                                         {"ugv.colour.noise", {3.0, 6.0}, {4.5, 8.0}},
                                         {"ugv.drift", {0.003, 0.008}, {0.005, 0.010}},
                                         {"ugv.noise", {0.003, 0.006}, {0.0045, 0.008}},
                                         {"ugv.pose_noise", {0.002, 0.005}, {0.0035, 0.007}},
                                         {"ugv.edge_density", {0.3, 0.5}, {0.2, 0.4}},
                                         {"ugv.camera_height", {0.8, 1.1}, {0.95, 1.3}}};
  return all;
}

/// Of a simulated field and of the two visits to it.
const std::vector<Drawn>& fieldSettings() {
  static const std::vector<Drawn> all = {{"field.gaps", {0.04, 0.12}, {0.08, 0.16}},
                                         {"field.row_wobble", {0.015, 0.03}, {0.02, 0.04}},
                                         {"field.weeds", {0.5, 2.0}, {1.0, 4.0}},
                                         {"field.straw", {0.0, 40.0}, {20.0, 80.0}},
                                         {"field.plant_size", {0.85, 1.1}, {0.95, 1.25}},
                                         {"field.relief", {0.01, 0.03}, {0.02, 0.05}},
                                         {"views.leaf_unshared", {0.4, 0.6}, {0.5, 0.7}},
                                         {"views.wind", {0.008, 0.024}, {0.015, 0.03}},
                                         {"views.growth", {1.0, 1.2}, {1.1, 1.3}},
                                         {"views.sun_hour", {9.0, 13.0}, {10.0, 15.0}},
                                         {"views.sun_hours", {-2.0, 3.0}, {-3.0, 1.0, 4.0}},
                                         {"views.overcast", {0.1, 0.5}, {0.0, 0.3, 0.8}},
                                         {"views.weeds_pulled", {0.0, 0.4}, {0.2, 0.5}},
                                         {"uav.height_noise", {0.004, 0.007}, {0.005, 0.009}},
                                         // Half of it is in every method's height error, as the
                                         // drone's map itself is off by so much.
                                         {"uav.dome", {0.02, 0.04}, {0.03, 0.05}},
                                         {"uav.holes", {0.01, 0.03}, {0.02, 0.04}},
                                         {"uav.colour.exposure", {0.75, 1.15}, {0.9, 1.4}},
                                         {"uav.colour.white_balance", {0.05, 0.15}, {0.10, 0.20}},
                                         {"uav.colour.gamma_spread", {0.05, 0.15}, {0.10, 0.20}},
                                         {"uav.colour.gradient", {0.05, 0.12}, {0.09, 0.16}},
                                         {"ugv.length", {8.0, 11.0}, {7.0, 9.5, 12.0}},
                                         {"ugv.width", {1.6, 2.2}, {1.9, 2.4}}};
  return all;
}

}  // namespace

std::vector<OptionRange> viewRanges(Settings settings, PairSource source) {
  std::vector<OptionRange> ranges;
  const auto add = [&](const std::vector<Drawn>& all) {
    for (const Drawn& one : all) {
      ranges.push_back(
          {one.path, 0.0, 0.0, settings == Settings::kDevelop ? one.develop : one.final});
    }
  };
  add(sensorSettings());
  if (source == PairSource::kSimulated) add(fieldSettings());
  return ranges;
}

}  // namespace agricolmap::experiments
