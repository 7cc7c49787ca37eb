#include "experiments/pairs/cases.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "experiments/pairs/hash.hpp"
#include "experiments/pairs/published.hpp"

namespace agricolmap::experiments {
namespace {

/// What the drone's cloud depends on, see Case::flightText.
bool belongsToFlight(const std::string& path) {
  static const std::vector<std::string> flight = {
      "views.leaf_unshared", "views.soil_kept", "views.wind",     "views.lean_deg",
      "views.ripeness",      "views.weeds_new", "views.sun_hour", "views.overcast"};
  return path.starts_with("field.") || path.starts_with("uav.") ||
         std::find(flight.begin(), flight.end(), path) != flight.end();
}

}  // namespace

std::string kindOf(PairSource source) {
  switch (source) {
    case PairSource::kPublished:
    case PairSource::kDates:
      return "real";
    case PairSource::kSimulated:
    case PairSource::kOtherGenerator:
      return "simulated";
    default:
      return "semi-real";
  }
}

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
    Random random = Random::stream(static_cast<std::uint64_t>(of), hashText(range.path));
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
  simulate::ViewOptions& views = flown.views;
  views.growth = usual.views.growth;
  views.growth_spread = usual.views.growth_spread;
  views.ripening = usual.views.ripening;
  views.sun_hours = usual.views.sun_hours;
  views.soil_contrast = usual.views.soil_contrast;
  views.weeds_pulled = usual.views.weeds_pulled;
  views.plants_lost = usual.views.plants_lost;
  flown.other_field = flown.beyond_map = flown.mirrored = false;
  return fmt::format("{} {}", static_cast<int>(source), config::dumpYaml(optionTable(flown)));
}

std::string Case::text() const {
  simulate::SimulationOptions copy = options;
  std::string text = fmt::format("{} {} {}\n{}", name, static_cast<int>(source), strips_per_field,
                                 config::dumpYaml(optionTable(copy)));
  for (const OptionRange& range : ranges) {
    text += fmt::format("{} {} {} {}\n", range.path, range.low, range.high,
                        fmt::join(range.values, " "));
  }
  if (published) text += publishedText(*published);
  if (dates) {
    text += fmt::format("{} {} {} {} {}\n", dates->fixed, dates->moving, dates->begin, dates->end,
                        dates->end_for_end);
  }
  if (slip) {
    text += fmt::format("{} {} {} {}{}\n", slip->metres, slip->share, slip->along, first_strip,
                        slip->twice ? " twice" : "");
  }
  text += folder;
  return text;
}

}  // namespace agricolmap::experiments
