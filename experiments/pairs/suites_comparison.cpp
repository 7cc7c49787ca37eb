// What all methods are compared on: the paper's four fields and two of real imagery, drawn anew for
// each pair, from guesses of known error.
#include <algorithm>
#include <string_view>
#include <utility>

#include "experiments/pairs/suite_parts.hpp"
#include "experiments/pairs/views.hpp"

namespace agricolmap::experiments {
namespace {

/// The case of the paper's suite that another one is made of.
struct Origin {
  std::string_view name;
  std::string_view of;
};
constexpr Origin kOrigins[] = {{"soybean", "soybean-easy"},
                               {"sugar-beet-10m", "sugar-beet-10m-easy"},
                               {"sugar-beet-20m", "sugar-beet-20m-easy"},
                               {"winter-wheat", "winter-wheat-easy"},
                               {"semireal-sugarbeet", "semireal-sugarbeet"},
                               {"real-soybean", "real-soybean"}};

// The scale errors of the panels of the paper's fig. correct_reg_rate.
constexpr double kScales[] = {0.0, 0.1, 0.2, 0.3};
constexpr double kTranslations[] = {0.0, 0.05, 0.13, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0};
constexpr double kHeadings[] = {0.0, 0.1, 0.2, 0.3, 0.4};
constexpr int kScalePercents[] = {0, 5, 10, 15, 20, 25, 30};
// Of the accuracy: small enough for methods that only refine.
constexpr double kSmallTranslation = 0.05;
constexpr double kSmallHeading = 0.01;

/// The suites disturb the exact guess themselves, for all methods alike.
void makeGuessExact(simulate::GeotagOptions& geotag) {
  geotag.translation = geotag.heading_deg = geotag.scale = 0.0;
  geotag.z = geotag.tilt_deg = geotag.across_rows = 0.0;
  geotag.unknown_scale = 1.0;
}

std::vector<Curve> translationCurves() {
  std::vector<Curve> curves;
  for (const double scale : kScales) {
    curves.push_back({.scale = scale, .errors = {}});
    for (const double size : kTranslations) {
      curves.back().errors.push_back({size, size, 0.0, scale});
    }
  }
  return curves;
}

std::vector<Curve> headingCurves() {
  std::vector<Curve> curves;
  for (const double scale : kScales) {
    curves.push_back({.scale = scale, .errors = {}});
    for (const double size : kHeadings) curves.back().errors.push_back({size, 0.0, size, scale});
  }
  return curves;
}

Curve accuracyCurve() {
  Curve curve;
  for (const int percent : kScalePercents) {
    const double scale = 0.01 * percent;
    curve.errors.push_back({scale, kSmallTranslation, kSmallHeading, scale});
  }
  return curve;
}

/// All errors at once, as a share of the largest that the paper allows for.
AddedError jointError(double share) { return {share, 5.0 * share, 0.2 * share, 0.3 * share}; }

/// A few guesses for a first look.
std::vector<Curve> quickCurves(const std::string& suite) {
  if (suite == "translation") return {{.errors = {{0.05, 0.05, 0.0, 0.0}, {5.0, 5.0, 0.0, 0.0}}}};
  if (suite == "heading") return {{.errors = {{0.2, 0.0, 0.2, 0.0}}}};
  if (suite == "joint") return {{.rising = false, .errors = {jointError(1.0)}}};
  return {{.errors = {{0.1, kSmallTranslation, kSmallHeading, 0.1}}}};
}

}  // namespace

std::vector<Curve> curvesOf(const std::string& suite, bool quick) {
  // One guess that is wrong in everything, by about what a geotag is.
  if (suite == "inliers") return {{.rising = false, .errors = {{1.0, 1.0, 0.05, 0.05}}}};
  if (quick) return quickCurves(suite);
  if (suite == "translation") return translationCurves();
  if (suite == "heading") return headingCurves();
  if (suite == "joint") return {{.rising = false, .errors = {jointError(0.5), jointError(1.0)}}};
  return {accuracyCurve()};
}

std::vector<Case> viewCases(const SuiteOptions& options) {
  const std::vector<Case> paper = paperCases({});
  std::vector<Case> cases;
  for (const Origin& origin : kOrigins) {
    Case made = *std::find_if(paper.begin(), paper.end(),
                              [&](const Case& one) { return one.name == origin.of; });
    made.name = origin.name;
    made.max_pairs = 0;
    made.ranges = viewRanges(options.settings, made.source);
    makeGuessExact(made.options.geotag);
    cases.push_back(std::move(made));
  }
  return cases;
}

}  // namespace agricolmap::experiments
