// Strips that are no affine's: bent by drift, for each length and crop, and slipped twice.
#include <fmt/format.h>

#include <algorithm>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

/// What the settings have in common with none of the others.
struct BendSettings {
  double rows;    ///< distance of rows, of the crop's
  double plants;  ///< and of plants
  double leaf_unshared;
  std::vector<double> drifts;  ///< shares of the strip's length
  std::vector<double> slips;   ///< [m]
};

BendSettings settingsOf(Settings settings) {
  if (settings == Settings::kDevelop) {
    return {0.92, 1.1, 0.55, {0.0, 0.006, 0.012, 0.018}, {0.12, 0.35}};
  }
  if (settings == Settings::kCalibrate) {
    return {1.15, 0.85, 0.45, {0.0, 0.004, 0.008, 0.015}, {0.18, 0.45}};
  }
  return {1.0, 1.0, 0.5, {0.0, 0.005, 0.01, 0.02}, {0.15, 0.25, 0.5}};
}

Case bendCase(const std::string& name, const NamedCrop& crop, const SuiteOptions& options,
              const BendSettings& settings) {
  Case made = cropCase(name, crop.crop, kPaperGuess, options.uniform);
  made.options.field.row_spacing *= settings.rows;
  made.options.field.plant_spacing *= settings.plants;
  made.options.views.leaf_unshared = settings.leaf_unshared;
  return made;
}

}  // namespace

std::vector<Case> bendCases(const SuiteOptions& options) {
  const BendSettings settings = settingsOf(options.settings);
  std::vector<Case> cases;
  for (const NamedCrop& crop : namedCrops()) {
    for (const double length : {10.0, 20.0}) {
      int strip = 0;  // of a length's field, one for each drift
      for (const double drift : settings.drifts) {
        Case made = bendCase(fmt::format("bend-{}m-{}-{}", length, drift, crop.name), crop, options,
                             settings);
        made.options.ugv.length = length;
        made.options.ugv.drift = drift;
        const double side = std::max(20.0, length + 4.0);
        made.options.field.width = made.options.field.height = side;
        made.setting = drift;
        made.first_strip = strip++;
        cases.push_back(std::move(made));
      }
    }
    int strip = 10;
    for (const double metres : settings.slips) {
      Case made = bendCase(fmt::format("twice-{}-{}", metres, crop.name), crop, options, settings);
      made.slip = {.metres = metres, .share = 1.0 / 3.0, .along = strip % 2 == 0, .twice = true};
      made.setting = metres;
      made.first_strip = strip++;
      cases.push_back(std::move(made));
    }
  }
  return cases;
}

}  // namespace agricolmap::experiments
