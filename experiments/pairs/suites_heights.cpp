// Where heights are hard to tell: canopies that close, drilled cereals, ridges and slopes, seen by
// a drone whose heights are blurred by 1.5 to 5 cm and that may see canopies lower than they are;
// and the same crops of the other generator. No two settings have a value in common.
#include <fmt/format.h>

#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

struct Kind {
  const char* name;
  simulate::Crop crop;
  std::vector<Drawn> drawn;
};

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"wheat",
       simulate::Crop::kWinterWheat,
       {{"field.plant_size", {0.9, 1.15}, {0.95, 1.2}, {1.0, 1.1}},
        {"field.row_spacing", {0.125, 0.14}, {0.12, 0.15}, {0.13, 0.145}}}},
      {"barley",
       simulate::Crop::kWinterWheat,
       {{"field.plant_size", {1.4, 1.7}, {1.35, 1.8}, {1.5, 1.6}},
        {"field.row_spacing", {0.125, 0.16}, {0.12, 0.17}, {0.13, 0.15}},
        {"field.plant_spacing", {0.03}, {0.028, 0.034}, {0.032}},
        {"views.ripeness", {0.2, 0.6}, {0.1, 0.7}, {0.3, 0.5}}}},
      {"closed-soybean",
       simulate::Crop::kSoybean,
       {{"field.plant_size", {1.6, 2.0}, {1.5, 2.1}, {1.7, 1.9}},
        {"field.row_spacing", {0.45, 0.5}, {0.42, 0.52}, {0.44, 0.48}}}},
      {"potato",
       simulate::Crop::kSugarBeet10m,
       {{"field.plant_size", {1.2, 1.7}, {1.1, 1.8}, {1.3, 1.5}},
        {"field.row_spacing", {0.75}, {0.72, 0.8}, {0.76}},
        {"field.plant_spacing", {0.33}, {0.3, 0.36}, {0.32}},
        {"field.ridge", {0.07, 0.11}, {0.06, 0.12}, {0.08, 0.1}}}},
      {"slope",
       simulate::Crop::kSoybean,
       {{"field.slope", {0.08, 0.1}, {0.07, 0.11}, {0.09, 0.105}},
        {"field.relief", {0.12, 0.18}, {0.1, 0.2}, {0.14, 0.16}},
        {"field.plant_size", {0.8, 1.2}, {0.7, 1.3}, {0.9, 1.1}}}}};
  return all;
}

/// Of the drone, in all kinds.
const std::vector<Drawn>& drone() {
  static const std::vector<Drawn> all = {
      {"uav.smoothing", {0.015, 0.03, 0.05}, {0.02, 0.035, 0.045}, {0.018, 0.028, 0.048}},
      {"uav.underestimate", {0.0, 0.25}, {0.05, 0.2}, {0.02, 0.22}},
      {"uav.height_noise", {0.004, 0.007}, {0.003, 0.008}, {0.005, 0.006}}};
  return all;
}

/// Of the two visits; the robot's camera is what heights of canopies hang on most.
const std::vector<Drawn>& views(bool hard) {
  static const std::vector<Drawn> fair = {
      {"views.leaf_unshared", {0.2, 0.4}, {0.25, 0.45}, {0.3, 0.35}},
      {"views.growth", {1.0, 1.06}, {1.02, 1.08}, {1.01, 1.05}},
      {"views.wind", {0.004, 0.01}, {0.006, 0.012}, {0.005, 0.008}},
      {"ugv.drift", {0.003, 0.005}, {0.0035, 0.006}, {0.004, 0.0045}},
      {"ugv.camera_height", {1.2, 1.6}, {1.1, 1.7}, {1.3, 1.5}}};
  static const std::vector<Drawn> hard_ones = {
      {"views.leaf_unshared", {0.55, 0.7}, {0.5, 0.75}, {0.6, 0.65}},
      {"views.growth", {1.2, 1.35}, {1.15, 1.4}, {1.25, 1.3}},
      {"views.wind", {0.02, 0.03}, {0.018, 0.028}, {0.022, 0.025}},
      {"views.sun_hours", {3.0, 4.0}, {2.5, 3.5}, {2.0, 4.5}},
      {"views.weeds_pulled", {0.4, 0.6}, {0.3, 0.7}, {0.5, 0.55}},
      {"ugv.drift", {0.009, 0.01}, {0.008, 0.011}, {0.0095, 0.0105}},
      {"ugv.camera_height", {0.8, 1.0}, {0.75, 1.05}, {0.85, 0.95}}};
  return hard ? hard_ones : fair;
}

class Builder {
 public:
  explicit Builder(const SuiteOptions& options) : options_(options) {}

  Case make(const Kind& kind, bool hard) const {
    Case made = cropCase(fmt::format("{}heights-{}-{}", prefix(), viewName(hard), kind.name),
                         kind.crop, kEasyGuess, options_.uniform);
    made.dataset = kind.name;
    // What the drone's own map is off by no registration can tell.
    made.options.uav.dome = 0.0;
    for (const std::vector<Drawn>* all : {&drone(), &views(hard), &kind.drawn}) {
      for (const Drawn& one : *all) made.ranges.push_back(one.in(options_.settings));
    }
    return made;
  }

  /// What scripts/other-generator made of this crop for heights.
  Case generated(const char* crop, bool hard) const {
    Case made;
    made.name = fmt::format("{}heights-{}-other-{}", prefix(), viewName(hard), crop);
    useImagery(made, PairSource::kOtherGenerator, crop);
    made.folder = fmt::format("other_generator/{}/heights-{}-{}", toString(options_.settings),
                              viewName(hard), crop);
    setGuess(made.options, {5.0, 8.0, 0.20}, false);
    return made;
  }

 private:
  static const char* viewName(bool hard) { return hard ? "hard" : "fair"; }
  std::string prefix() const {
    return options_.settings == Settings::kFinal ? "" : toString(options_.settings) + "-";
  }

  SuiteOptions options_;
};

}  // namespace

std::vector<Case> heightsCases(const SuiteOptions& options) {
  const Builder builder(options);
  std::vector<Case> cases;
  for (const bool hard : {false, true}) {
    for (const Kind& kind : kinds()) cases.push_back(builder.make(kind, hard));
    for (const char* crop : {"wheat", "barley", "closed-soybean", "sugarbeet"}) {
      cases.push_back(builder.generated(crop, hard));
    }
  }
  return cases;
}

}  // namespace agricolmap::experiments
