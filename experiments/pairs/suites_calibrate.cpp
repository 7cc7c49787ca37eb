// What the verdict's probability is fitted to: right and wrong answers of settings that neither the
// reported figures nor the development use, drawn anew for each field and strip.
#include <fmt/format.h>

#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

/// The settings of the calibration. Factors of the crop's own are spelled out for it.
std::vector<OptionRange> calibrationRanges(const simulate::SimulationOptions& crop) {
  const auto times = [](double value, double low, double high) {
    return std::pair<double, double>(value * low, value * high);
  };
  const auto [row_low, row_high] = times(crop.field.row_spacing, 1.12, 1.18);
  const auto [plant_low, plant_high] = times(crop.field.plant_spacing, 0.82, 0.88);
  const auto [gsd_low, gsd_high] = times(crop.uav.gsd, 1.2, 1.4);
  return {{"field.row_spacing", row_low, row_high},
          {"field.plant_spacing", plant_low, plant_high},
          {"field.width", 15.0, 24.0},
          {"field.height", 15.0, 24.0},
          {"field.gaps", 0.0, 0.0, {0.02, 0.15, 0.3}},
          {"field.row_wobble", 0.015, 0.05},
          {"field.weeds", 0.3, 4.0},
          {"uav.gsd", gsd_low, gsd_high},
          {"uav.smoothing", 0.035, 0.05},
          {"uav.height_noise", 0.005, 0.008},
          {"uav.dome", 0.05, 0.08},
          {"views.leaf_unshared", 0.0, 0.0, {0.3, 0.55, 0.75, 0.9}},
          {"views.wind", 0.015, 0.025},
          {"views.growth", 0.0, 0.0, {1.15, 1.6}},
          {"views.sun_hours", 0.0, 0.0, {-2.0, 2.0, 3.0}},
          {"views.weeds_pulled", 0.1, 0.4},
          {"ugv.length", 0.0, 0.0, {5.0, 8.0}},
          {"ugv.width", 0.0, 0.0, {1.8, 2.0}},
          {"ugv.spacing", 0.005, 0.007},
          {"ugv.noise", 0.004, 0.006},
          {"ugv.drift", 0.0, 0.0, {0.003, 0.008, 0.02}},
          {"ugv.overhang", 0.0, 0.0, {0.0, 0.0, 0.0, 0.25, 0.5}}};
}

/// One kind of pairs, changed from a strip that the map shows.
struct Kind {
  std::string name;
  void (*change)(Case&);
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"right", [](Case&) {}},
      {"other-field", [](Case& made) { made.options.other_field = true; }},
      {"no-overlap", [](Case& made) { made.options.beyond_map = true; }},
      {"mirrored", [](Case& made) { made.options.mirrored = true; }},
      {"grown", [](Case& made) {
         // Another range than the other cases', and than the reported figures'.
         made.ranges.push_back({"views.growth", 1.9, 2.3});
         made.ranges.push_back({"views.leaf_unshared", 0.95, 0.95});
       }}};
  return all;
}

constexpr int kStrips = 6;  // of a field

}  // namespace

std::vector<Case> calibrateCases(const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const auto& [name, crop] : namedCrops()) {
    const auto start = [&, crop = crop, name = name](const std::string& kind) {
      Case made =
          cropCase(fmt::format("cal-{}-{}", kind, name), crop, kPaperGuess, options.uniform);
      made.ranges = calibrationRanges(made.options);
      made.strips_per_field = kStrips;
      return made;
    };
    for (const Kind& kind : kinds()) {
      cases.push_back(start(kind.name));
      kind.change(cases.back());
      cases.push_back(start(kind.name + "-none"));
      kind.change(cases.back());
      forgetGuess(cases.back());
    }
    Case shifted = start("row-shift");
    // The shift is a number of rows as they are: no range for their distance.
    std::erase_if(shifted.ranges,
                  [](const OptionRange& range) { return range.path == "field.row_spacing"; });
    shifted.options.field.row_spacing *= 1.15;
    shiftByRows(shifted);
    cases.push_back(std::move(shifted));
  }
  return cases;
}

}  // namespace agricolmap::experiments
