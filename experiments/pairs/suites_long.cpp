// Strips longer than any pose holds for, and strips over ground that is not flat. No two settings
// have a value in common.
#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

constexpr int kStrips = 3;       // of a field
constexpr double kRoom = 6.0;    // of the field beyond the strip [m]
constexpr double kHectare = 90;  // longer strips are flown higher, and drawn in coarser cells [m]

std::string prefix(const SuiteOptions& options) {
  return pick<std::string>(options.settings, "dev-", "cal-", "");
}

Case fieldCase(const SuiteOptions& options, std::string name, simulate::Crop crop) {
  Case made = cropCase(std::move(name), crop, kPaperGuess, options.uniform);
  made.strips_per_field = kStrips;
  made.options.field.row_spacing *= pick(options.settings, 0.91, 1.09, 1.03);
  made.options.field.plant_spacing *= pick(options.settings, 1.12, 0.93, 1.06);
  return made;
}

Case longCase(const SuiteOptions& options, const NamedCrop& crop, double length, double drift,
              const std::string& what) {
  Case made = fieldCase(options,
                        fmt::format("{}long-{}{:g}m-{:g}-{}", prefix(options), what, length,
                                    100.0 * drift, crop.name),
                        crop.crop);
  made.setting = length;
  made.options.field.width = made.options.field.height = length + kRoom;
  made.options.ugv.length = length;
  made.options.ugv.drift = drift;
  const bool high = length > kHectare;
  made.options.uav.gsd = high ? 0.034 : 0.02;
  made.options.uav.canvas = high ? 0.017 : 0.01;
  made.options.ugv.spacing = high ? 0.009 : 0.006;
  return made;
}

struct Terrain {
  const char* name;
  std::vector<Drawn> shapes;
};

const std::vector<Terrain>& terrains() {
  static const std::vector<Terrain> all = {
      {"hills",
       {{"field.slope", {0.07, 0.12}, {0.08, 0.11}, {0.1}},
        {"field.relief", {0.3, 0.45}, {0.35, 0.55}, {0.5}},
        {"field.relief_length", {14.0, 25.0}, {16.0, 30.0}, {18.0, 22.0}}}},
      {"ridges",
       {{"field.ridge", {0.07, 0.12}, {0.08, 0.13}, {0.09, 0.11}},
        {"field.slope", {0.03}, {0.04}, {0.05}}}},
      {"ruts",
       {{"field.track_depth", {0.1, 0.2}, {0.12, 0.22}, {0.15, 0.18}},
        {"field.tramline_spacing", {3.6}, {4.2}, {4.0}}}},
      {"terraces",
       {{"field.terrace", {0.2, 0.5}, {0.25, 0.6}, {0.3, 0.4}},
        {"field.terrace_length", {5.0, 8.0}, {5.5, 9.0}, {6.0, 7.0}}}}};
  return all;
}

}  // namespace

std::vector<Case> longCases(const SuiteOptions& options) {
  const auto drifts = pick<std::vector<double>>(options.settings, {0.006, 0.016}, {0.008, 0.018},
                                                {0.005, 0.01, 0.02});
  std::vector<Case> cases;
  for (const double length : {20.0, 40.0, 100.0}) {
    for (const NamedCrop& crop : namedCrops()) {
      // A hectare of what is sown densely takes minutes.
      const bool wheat = crop.crop == simulate::Crop::kWinterWheat;
      if (crop.crop == simulate::Crop::kSugarBeet20m || crop.crop == simulate::Crop::kMaize ||
          (wheat && length > kHectare)) {
        continue;
      }
      for (const double drift : drifts) {
        cases.push_back(longCase(options, crop, length, drift, ""));
      }
      if (length > kHectare) continue;
      cases.push_back(longCase(options, crop, length, drifts.front(), "neg-other-field-"));
      cases.back().options.other_field = true;
      cases.push_back(longCase(options, crop, length, drifts.front(), "back-"));
      cases.back().options.ugv.back = true;
      cases.back().options.ugv.back_aside = pick(options.settings, 2.1, 1.7, 1.9);
    }
  }
  return cases;
}

std::vector<Case> terrainCases(const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const Terrain& terrain : terrains()) {
    for (const NamedCrop& crop : namedCrops()) {
      if (crop.crop == simulate::Crop::kSugarBeet20m) continue;
      Case made = fieldCase(
          options, fmt::format("{}terrain-{}-{}", prefix(options), terrain.name, crop.name),
          crop.crop);
      for (const Drawn& shape : terrain.shapes) {
        made.ranges.push_back(shape.in(options.settings));
      }
      cases.push_back(std::move(made));
    }
  }
  return cases;
}

}  // namespace agricolmap::experiments
