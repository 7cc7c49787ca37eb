#include "experiments/pairs/cases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "experiments/pairs/suites.hpp"

namespace agricolmap::experiments {
namespace {

using Suite = std::pair<std::string, std::function<std::vector<Case>(bool)>>;

const std::vector<Suite>& suites() {
  static const std::vector<Suite> all = {{"paper", paperSuite},
                                         {"locate", locateSuite},
                                         {"curves", curvesSuite},
                                         {"calibrate", calibrateSuite},
                                         {"develop", developSuite}};
  return all;
}

/// What the drone's cloud depends on, see Case::flightText.
bool belongsToFlight(const std::string& path) {
  static const std::vector<std::string> flight = {"views.leaf_unshared", "views.wind",
                                                  "views.sun_hour", "views.overcast"};
  return path.starts_with("field.") || path.starts_with("uav.") ||
         std::find(flight.begin(), flight.end(), path) != flight.end();
}

/// FNV-1a: the same draw for an option whatever other ranges a case has.
std::uint64_t hashPath(const std::string& path) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char c : path) hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001B3ULL;
  return hash;
}

}  // namespace

simulate::SimulationOptions Case::optionsFor(int seed) const {
  simulate::SimulationOptions drawn = options;
  drawn.seed = fieldSeed(seed);
  const OptionTable table = optionTable(drawn);
  for (const OptionRange& range : ranges) {
    const OptionField* field = table.find(range.path);
    if (field == nullptr || !std::holds_alternative<double*>(field->value)) {
      throw UsageError(fmt::format("case {}: no number is called {}", name, range.path));
    }
    const int of = belongsToFlight(range.path) ? fieldSeed(seed) : seed;
    Random random = Random::stream(static_cast<std::uint64_t>(of), hashPath(range.path));
    *std::get<double*>(field->value) = range.values.empty()
                                           ? random.uniform(range.low, range.high)
                                           : range.values[random.below(range.values.size())];
  }
  return drawn;
}

std::string Case::flightText(int seed) const {
  simulate::SimulationOptions flown = optionsFor(seed);
  const simulate::GeotagOptions geotag = flown.geotag;
  const simulate::SimulationOptions usual;
  flown.ugv = usual.ugv;
  flown.geotag = usual.geotag;
  flown.geotag.utm = geotag.utm;
  flown.views.growth = usual.views.growth;
  flown.views.sun_hours = usual.views.sun_hours;
  flown.views.weeds_pulled = usual.views.weeds_pulled;
  flown.other_field = flown.beyond_map = flown.mirrored = false;
  return fmt::format("{} {}", static_cast<int>(source), config::dumpYaml(optionTable(flown)));
}

std::string Case::text() const {
  simulate::SimulationOptions copy = options;
  std::string text =
      fmt::format("{} {} {} {}\n{}", name, static_cast<int>(source), strips_per_field,
                  scale_unknown, config::dumpYaml(optionTable(copy)));
  for (const OptionRange& range : ranges) {
    text += fmt::format("{} {} {} {}\n", range.path, range.low, range.high,
                        fmt::join(range.values, " "));
  }
  if (prior)
    text += fmt::format("{} {} {}\n", prior->translation, prior->heading_deg, prior->scale);
  return text;
}

std::vector<std::string> suiteNames() {
  std::vector<std::string> names;
  for (const Suite& suite : suites()) names.push_back(suite.first);
  return names;
}

std::vector<Case> suiteCases(const std::string& suite, bool uniform) {
  for (const auto& [name, make] : suites()) {
    if (name == suite) return make(uniform);
  }
  throw UsageError(
      fmt::format("unknown suite '{}'; there are: {}", suite, fmt::join(suiteNames(), ", ")));
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

const NamedCrop& namedCrop(simulate::Crop crop) {
  return *std::find_if(namedCrops().begin(), namedCrops().end(),
                       [&](const NamedCrop& one) { return one.crop == crop; });
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

Case cropCase(std::string name, simulate::Crop crop, const GuessError& error, bool uniform,
                      const Target& target) {
  Case made;
  made.name = std::move(name);
  made.options = simulate::cropPreset(crop);
  made.target = target;
  setGuess(made.options, error, uniform);
  return made;
}

void forgetGuess(Case& made) {
  // Uniform, as every heading must be as likely as every other.
  setGuess(made.options, {made.options.field.width, 180.0, 0.30}, true);
  made.prior = PriorUncertainty::none();
}

void shiftByRows(Case& made) {
  const double spacing = made.options.field.row_spacing;
  made.options.geotag.across_rows = spacing * std::max(1.0, std::round(0.5 / spacing));
  setGuess(made.options, {0.1, 1.0, 0.03}, false);
  made.prior = PriorUncertainty{.translation = 0.3, .heading_deg = 3.0, .scale = 0.05};
}

}  // namespace agricolmap::experiments
