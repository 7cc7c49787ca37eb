// Views that the product's simulator did not make, and files that are wrong in themselves: flights
// of a real field on other dates, their mirrored copies, another generator's fields, odometry
// slips.
#include <fmt/format.h>

#include <tuple>
#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

/// The part of the real field that strips come from, as shares of its length.
std::pair<double, double> partOf(Settings settings) {
  if (settings == Settings::kDevelop) return {0.0, 0.32};
  if (settings == Settings::kCalibrate) return {0.32, 0.62};
  return {0.62, 1.0};
}

/// Strips of one date on the map of another. The truth is their common georeference, which is good
/// to 1 to 4 cm itself: right within 5 cm cannot be asked of all.
Case dateCase(const std::string& name, const SuiteOptions& options, DatePair dates) {
  const bool one_week = dates.fixed == "22" || dates.moving == "22";
  const std::string days = fmt::format("{}-{}", dates.fixed, dates.moving);
  Case made = cropCase(fmt::format("{}-{}w-{}", name, one_week ? 1 : 2, days),
                       simulate::Crop::kSoybean, {2.0, 6.0, 0.10}, options.uniform);
  useImagery(made, PairSource::kDates, days);
  std::tie(dates.begin, dates.end) = partOf(options.settings);
  made.dates = std::move(dates);
  made.options.ugv.length = 10.0;
  made.options.ugv.width = 3.0;
  made.options.geotag.z = made.options.geotag.tilt_deg = 0.0;
  return made;
}

template <typename Add>
void forDates(const Add& add) {
  for (const auto& [fixed, moving] : {std::pair("15", "22"),
                                      {"22", "15"},
                                      {"22", "29"},
                                      {"29", "22"},
                                      {"15", "29"},
                                      {"29", "15"}}) {
    add(DatePair{.fixed = fixed, .moving = moving});
  }
}

/// Tells the registration hardly more than the guess is off by, instead of the paper's limits.
Case tight(Case made) {
  made.name = "tight-" + made.name;
  made.told = PriorUncertainty{.translation = 2.5, .heading_deg = 8.0, .scale = 0.12};
  return made;
}

/// How far the settings' plants stand apart, of the crop's own distances.
std::pair<double, double> spacingOf(Settings settings) {
  if (settings == Settings::kDevelop) return {0.92, 1.1};
  if (settings == Settings::kCalibrate) return {1.15, 0.85};
  return {1.0, 1.0};
}

}  // namespace

std::vector<Case> dateCases(const SuiteOptions& options) {
  std::vector<Case> cases;
  forDates([&](const DatePair& dates) { cases.push_back(dateCase("dates", options, dates)); });
  forDates(
      [&](const DatePair& dates) { cases.push_back(tight(dateCase("dates", options, dates))); });
  return cases;
}

std::vector<Case> mirroredDateCases(const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const bool end_for_end : {false, true}) {
    for (const bool is_tight : {false, true}) {
      forDates([&](DatePair dates) {
        dates.end_for_end = end_for_end;
        Case made = dateCase(end_for_end ? "mirrored-ends" : "mirrored-sides", options, dates);
        made.options.mirrored = true;
        cases.push_back(is_tight ? tight(std::move(made)) : std::move(made));
      });
    }
  }
  return cases;
}

std::vector<Case> slipCases(const SuiteOptions& options) {
  const auto [rows, plants] = spacingOf(options.settings);
  std::vector<Case> cases;
  for (const auto& [name, crop] : namedCrops()) {
    int strip = 0;  // each slip has a strip of its own in the field of a seed
    for (const bool along : {false, true}) {
      for (const auto& [part, share] : {std::pair("half", 0.5), {"third", 1.0 / 3.0}}) {
        for (const double metres : {0.1, 0.15, 0.2, 0.3, 0.6}) {
          Case made = cropCase(
              fmt::format("slip-{}-{}-{}-{}", part, along ? "along" : "across", metres, name), crop,
              kPaperGuess, options.uniform);
          made.options.field.row_spacing *= rows;
          made.options.field.plant_spacing *= plants;
          made.slip = {.metres = metres, .share = share, .along = along};
          made.setting = metres;
          made.first_strip = strip++;
          cases.push_back(std::move(made));
        }
      }
    }
  }
  return cases;
}

std::vector<Case> otherGeneratorCases(const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const char* views : {"fair", "hard"}) {
    for (const char* crop : {"soybean", "sugarbeet", "wheat", "maize", "lettuce"}) {
      Case made;
      made.name = fmt::format("{}-{}", views, crop);
      useImagery(made, PairSource::kOtherGenerator, crop);
      made.folder = fmt::format("other_generator/{}/{}", toString(options.settings), made.name);
      // What scripts/other-generator tells it, for the rows to say.
      setGuess(made.options, {5.0, 8.0, 0.20}, false);
      cases.push_back(std::move(made));
    }
  }
  return cases;
}

}  // namespace agricolmap::experiments
