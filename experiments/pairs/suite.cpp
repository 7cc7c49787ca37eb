#include "experiments/pairs/suite.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

constexpr std::array<std::pair<Settings, const char*>, 3> kSettings = {
    {{Settings::kDevelop, "develop"},
     {Settings::kCalibrate, "calibrate"},
     {Settings::kFinal, "final"}}};

using MakeCases = std::vector<Case> (*)(const SuiteOptions&);

/// A suite's cases for one of the settings it has.
struct Entry {
  const char* suite;
  Settings settings;
  MakeCases cases;
  int pairs = 60;
  int first_seed = 5001;
};
const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = [] {
    std::vector<Entry> made = {{"paper", Settings::kFinal, paperCases},
                               {"locate", Settings::kFinal, locateCases},
                               {"locate", Settings::kDevelop, locateCases},
                               {"locate", Settings::kCalibrate, calibrateCases},
                               {"curves", Settings::kFinal, curvesCases},
                               {"elsewhere-sim", Settings::kFinal, elsewhereCases},
                               {"elsewhere-sim", Settings::kDevelop, elsewhereCases},
                               {"elsewhere-sim", Settings::kCalibrate, elsewhereCases}};
    for (const char* name : {"translation", "heading", "joint", "accuracy", "inliers"}) {
      made.push_back({name, Settings::kFinal, viewCases});
      made.push_back({name, Settings::kDevelop, viewCases});
    }
    const auto add = [&](const char* name, MakeCases cases, int pairs, int first, int apart) {
      for (int i = 0; i < 3; ++i) {
        made.push_back({name, kSettings[i].first, cases, pairs, first + i * apart});
      }
    };
    add("dates", dateCases, 20, 5001, 0);
    add("mirrored", mirroredDateCases, 20, 5001, 0);
    add("slips", slipCases, 1, 5001, 0);
    add("long", longCases, 3, 60000, 3000);
    add("terrain", terrainCases, 6, 60000, 3000);
    add("bends", bendCases, 1, 7001, 0);
    add("other-generator", otherGeneratorCases, 4, 1001, 1000);  // as its script's
    add("heights", heightsCases, 4, 1001, 1000);                 // likewise
    return made;
  }();
  return all;
}

std::string namesOf(const std::vector<Settings>& settings) {
  std::vector<std::string> names;
  for (const Settings one : settings) names.push_back(toString(one));
  return fmt::format("{}", fmt::join(names, ", "));
}

}  // namespace

std::string toString(Settings settings) {
  for (const auto& [one, name] : kSettings) {
    if (one == settings) return name;
  }
  return {};
}

Settings parseSettings(const std::string& name) {
  for (const auto& [one, known] : kSettings) {
    if (known == name) return one;
  }
  throw UsageError(
      fmt::format("unknown settings '{}'; there are: develop, calibrate, final", name));
}

std::vector<std::string> suiteNames() {
  std::vector<std::string> names;
  for (const Entry& entry : entries()) {
    if (names.empty() || names.back() != entry.suite) names.emplace_back(entry.suite);
  }
  return names;
}

std::vector<Settings> settingsOf(const std::string& suite) {
  std::vector<Settings> settings;
  for (const Entry& entry : entries()) {
    if (entry.suite == suite) settings.push_back(entry.settings);
  }
  return settings;
}

Suite makeSuite(const std::string& name, const SuiteOptions& options) {
  const std::vector<Settings> known = settingsOf(name);
  if (known.empty()) {
    throw UsageError(
        fmt::format("unknown suite '{}'; there are: {}", name, fmt::join(suiteNames(), ", ")));
  }
  for (const Entry& entry : entries()) {
    if (entry.suite != name || entry.settings != options.settings) continue;
    Suite suite{.name = name,
                .settings = options.settings,
                .cases = entry.cases(options),
                .pairs = entry.pairs,
                .first_seed = entry.first_seed};
    if (entry.cases == viewCases) {
      suite.curves = curvesOf(name, options.quick);
      suite.matching_only = name == "inliers";
      suite.pairs = 2;
      suite.first_seed = 80001;
    }
    if (options.quick) {
      suite.pairs = 1;
      for (Case& one : suite.cases) shrink(one);
    }
    return suite;
  }
  throw UsageError(fmt::format("the suite '{}' has no settings '{}'; it has: {}", name,
                               toString(options.settings), namesOf(known)));
}

const std::vector<NamedCrop>& namedCrops() {
  static const std::vector<NamedCrop> all = {{"soybean", simulate::Crop::kSoybean},
                                             {"sugar-beet-10m", simulate::Crop::kSugarBeet10m},
                                             {"sugar-beet-20m", simulate::Crop::kSugarBeet20m},
                                             {"winter-wheat", simulate::Crop::kWinterWheat},
                                             {"maize", simulate::Crop::kMaize}};
  return all;
}

std::vector<NamedCrop> rowCrops() {
  std::vector<NamedCrop> crops = namedCrops();
  std::erase_if(crops,
                [](const NamedCrop& one) { return one.crop == simulate::Crop::kWinterWheat; });
  return crops;
}

const std::string& nameOf(simulate::Crop crop) {
  return std::find_if(namedCrops().begin(), namedCrops().end(),
                      [&](const NamedCrop& one) { return one.crop == crop; })
      ->name;
}

void setGuess(simulate::SimulationOptions& options, const GuessError& error, bool uniform) {
  options.geotag.translation = error.translation;
  options.geotag.heading_deg = error.heading_deg;
  options.geotag.scale = error.scale;
  options.geotag.uniform = uniform;
}

void setDifference(simulate::SimulationOptions& options, const Difference& difference) {
  options.views.leaf_unshared = difference.leaf_unshared;
  options.views.wind = difference.wind;
  options.views.growth = difference.growth;
  options.views.sun_hours = difference.sun_hours;
  options.views.weeds_pulled = difference.weeds_pulled;
  options.ugv.drift = difference.drift;
}

Case cropCase(std::string name, simulate::Crop crop, const GuessError& error, bool uniform) {
  Case made;
  made.name = std::move(name);
  made.dataset = nameOf(crop);
  made.options = simulate::cropPreset(crop);
  setGuess(made.options, error, uniform);
  return made;
}

void useImagery(Case& made, PairSource source, std::string dataset) {
  made.source = source;
  made.dataset = std::move(dataset);
}

void forgetGuess(Case& made) {
  // Uniform, as every heading must be as likely as every other.
  setGuess(made.options, {made.options.field.width, 180.0, 0.30}, true);
  made.told = PriorUncertainty::none();
}

void shiftByRows(Case& made) {
  const double spacing = made.options.field.row_spacing;
  made.options.geotag.across_rows = spacing * std::max(1.0, std::round(0.5 / spacing));
  setGuess(made.options, {0.1, 1.0, 0.03}, false);
  made.told = PriorUncertainty{.translation = 0.3, .heading_deg = 3.0, .scale = 0.05};
}

void shrink(Case& made) {
  if (made.source == PairSource::kSimulated) {
    made.options.field.width = made.options.field.height = 14.0;
  }
  made.options.ugv.length = 6.0;
  std::erase_if(made.ranges, [](const OptionRange& one) {
    return one.path == "ugv.length" || one.path == "field.width" || one.path == "field.height";
  });
}

}  // namespace agricolmap::experiments
