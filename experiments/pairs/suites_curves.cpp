// One setting varied at a time, all others as in fair views with the paper's errors of the guess:
// to see where it breaks.
#include <fmt/format.h>

#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

/// The values of one option, under the name that its cases carry.
struct Series {
  std::string name;
  std::string path;  ///< in SimulationOptions
  std::vector<double> values;
  double field = 20.0;  ///< side of the field [m]
};

const std::vector<Series>& series() {
  static const std::vector<Series> all = {
      // The field must hold 20 m in any direction.
      {"length", "ugv.length", {2.0, 3.0, 5.0, 7.0, 10.0, 20.0}, 24.0},
      {"overhang", "ugv.overhang", {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6}},
      {"gaps", "field.gaps", {0.05, 0.10, 0.20, 0.30, 0.40, 0.50}},
      {"plant-size", "field.plant_size", {0.3, 0.5, 0.7, 1.0, 1.4, 1.8, 2.4, 3.2}},
      {"leaf-unshared", "views.leaf_unshared", {0.0, 0.2, 0.4, 0.6, 0.8, 1.0}},
      {"growth", "views.growth", {1.0, 1.2, 1.4, 1.6, 1.8, 2.0}},
      {"drift", "ugv.drift", {0.0, 0.0025, 0.005, 0.01, 0.015, 0.02, 0.03}}};
  return all;
}

}  // namespace

std::vector<Case> curvesCases(const SuiteOptions& options) {
  std::vector<Case> cases;
  for (const simulate::Crop crop : {simulate::Crop::kSugarBeet10m, simulate::Crop::kWinterWheat}) {
    for (const Series& one : series()) {
      for (const double value : one.values) {
        Case made = cropCase(fmt::format("curve-{}-{}={}", nameOf(crop), one.name, value), crop,
                             kPaperGuess, options.uniform);
        made.options.field.width = one.field;
        made.options.field.height = one.field;
        made.ranges = {{one.path, value, value}};
        made.setting = value;
        made.strips_per_field = 6;
        cases.push_back(std::move(made));
      }
    }
  }
  return cases;
}

}  // namespace agricolmap::experiments
