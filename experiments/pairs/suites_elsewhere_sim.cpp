// What the crops' presets do not have and real flights do: wind from one side, ripening, green
// soil, rows sown by satellite, trials, mosaics of pieces, stones and straw; with and without a
// right place. No two settings have a value in common.
#include <fmt/format.h>

#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

/// One way in which fields or flights differ from the presets.
struct Kind {
  const char* name;
  std::vector<Drawn> drawn;
  void (*change)(simulate::SimulationOptions&) = [](simulate::SimulationOptions&) {};
};

/// Of all kinds.
const std::vector<Drawn>& usual() {
  static const std::vector<Drawn> all = {
      {"field.gaps", {0.03, 0.11}, {0.04, 0.14}, {0.05, 0.12}},
      {"field.weeds", {0.5, 3.0}, {0.8, 4.0}, {0.6, 2.5}},
      {"field.tone_spread", {1.1, 1.6}, {1.4, 2.0}, {1.2, 1.8}},
      {"field.soil.contrast", {0.8, 1.5}, {1.2, 2.0}, {1.1, 1.7}},
      {"field.soil.straw_brightness", {1.2, 1.8}, {1.4, 2.1}, {1.3, 1.6}},
      {"views.leaf_unshared", {0.35, 0.5}, {0.3, 0.45, 0.6}, {0.4, 0.57}},
      {"views.soil_kept", {0.3, 0.8}, {0.5, 0.9}, {0.4, 0.7}},
      {"views.soil_contrast", {0.7, 1.2}, {0.6, 0.9, 1.3}, {0.8, 1.1}},
      {"views.wind", {0.008, 0.02}, {0.012, 0.025}, {0.01, 0.022}},
      {"views.growth", {1.05, 1.2}, {1.1, 1.3}, {1.08, 1.25}},
      {"views.sun_hours", {-2.0, 3.0}, {-3.0, 1.5, 4.0}, {-1.5, 2.5}},
      {"views.overcast", {0.1, 0.5}, {0.2, 0.7}, {0.15, 0.4}},
      {"uav.colour_blur", {0.5, 1.0}, {0.6, 1.4}, {0.7, 1.2}},
      {"ugv.length", {9.0}, {6.0, 8.0}, {10.0}},
      {"ugv.width", {2.1}, {1.8, 2.0}, {2.2}}};
  return all;
}

void sowBySatellite(simulate::SimulationOptions& options) {
  options.field.synchronous = true;
  options.field.pass_error = 0.003;
}

void layOutTrial(simulate::SimulationOptions& options) {
  options.field.plots.rows = 4;
  options.field.plots.gap_rows = 1;
  options.field.tramline_spacing = 0.0;
}

const std::vector<Kind>& kinds() {
  static const std::vector<Kind> all = {
      {"leaning", {{"views.lean_deg", {6.0, 14.0}, {4.0, 9.0, 18.0}, {7.0, 12.0}}}},
      {"week",
       {{"views.growth", {1.22, 1.4}, {1.15, 1.5}, {1.18, 1.35}},
        {"views.growth_spread", {0.08, 0.15}, {0.1, 0.2}, {0.09, 0.18}},
        {"views.ripening", {0.05, 0.25}, {0.1, 0.35}, {0.15, 0.3}},
        {"views.leaf_unshared", {0.62, 0.8}, {0.7, 0.9}, {0.65, 0.85}},
        {"views.weeds_pulled", {0.2, 0.5}, {0.3, 0.8}, {0.4, 0.6}},
        {"views.weeds_new", {0.1, 0.3}, {0.2, 0.5}, {0.15, 0.4}},
        {"views.plants_lost", {0.01, 0.03}, {0.02, 0.06}, {0.015, 0.04}}}},
      {"month",
       {{"views.growth", {1.45, 1.7}, {1.42, 1.8}, {1.55, 1.65}},
        {"views.growth_spread", {0.12, 0.22}, {0.14, 0.25}, {0.16, 0.19}},
        {"views.ripeness", {0.2, 0.6}, {0.1, 0.55}, {0.25, 0.45}},
        {"views.ripening", {0.8, 1.2}, {0.75, 1.3}, {0.85, 1.1}},
        {"views.leaf_unshared", {0.92, 0.98}, {0.94, 1.0}, {0.93, 0.97}},
        {"views.soil_kept", {0.1, 0.25}, {0.0, 0.2}, {0.15, 0.35}},
        {"views.lean_deg", {3.0, 8.0}, {5.0, 10.0}, {2.0, 11.0}},
        {"views.weeds_pulled", {0.7, 0.9}, {0.65, 0.85}, {0.75, 0.95}},
        {"views.weeds_new", {0.35, 0.6}, {0.45, 0.7}, {0.55, 0.65}},
        {"views.plants_lost", {0.05, 0.1}, {0.07, 0.12}, {0.08, 0.09}},
        {"field.plots.length", {5.0}, {4.2, 8.0}, {5.8, 6.5}},
        {"field.plots.spread", {0.11, 0.17}, {0.09, 0.19}, {0.145, 0.155}}},
       layOutTrial},
      {"ripe",
       {{"views.ripeness", {0.4, 1.1}, {0.3, 0.7, 1.4}, {0.5, 0.9, 1.2}},
        {"views.ripening", {0.12, 0.5}, {0.2, 0.7}, {0.15, 0.6}},
        {"field.plots.spread", {0.06, 0.12}, {0.08, 0.16}, {0.07, 0.14}}}},
      {"green",
       {{"field.soil.cover", {0.4, 0.8}, {0.3, 0.6, 0.95}, {0.5, 0.85}},
        {"field.weeds", {6.0, 15.0}, {8.0, 20.0}, {7.0, 12.0}}}},
      {"satellite",
       {{"field.plant_jitter", {0.02, 0.04}, {0.015, 0.03}, {0.018, 0.025}},
        {"field.lateral_jitter", {0.002}, {0.003}, {0.0025}},
        {"field.row_wobble", {0.002, 0.006}, {0.003, 0.01}, {0.004, 0.008}},
        {"field.gaps", {0.0}, {0.005}, {0.002}},
        {"field.size_spread", {0.08, 0.12}, {0.06, 0.15}, {0.07, 0.1}}},
       sowBySatellite},
      {"trial",
       {{"field.plots.length", {4.0, 6.0}, {3.5, 7.0}, {4.5, 5.5}},
        {"field.plots.alley", {1.0, 1.6}, {0.8, 1.8}, {1.2, 1.5}},
        {"field.plots.spread", {0.1, 0.2}, {0.13, 0.25}, {0.18, 0.22}},
        {"field.plots.mixed", {0.0, 0.5}, {0.2, 0.4}, {0.15, 0.3}}},
       layOutTrial},
      {"pieces",
       {{"uav.mosaic.piece", {4.0, 7.0}, {3.0, 8.0}, {5.0, 6.5}},
        {"uav.mosaic.shift", {0.01, 0.025}, {0.015, 0.035}, {0.012, 0.03}},
        {"uav.mosaic.shear", {0.001, 0.003}, {0.002, 0.004}, {0.0015, 0.0025}},
        {"uav.mosaic.blur", {1.5, 3.0}, {1.0, 4.0}, {2.0, 3.5}},
        {"uav.mosaic.exposure", {0.04, 0.1}, {0.06, 0.12}, {0.05, 0.08}},
        {"uav.mosaic.doubled", {0.1, 0.3}, {0.2, 0.4}, {0.15, 0.25}}}},
      {"stony",
       {{"field.soil.stones", {10.0, 50.0}, {15.0, 80.0}, {20.0, 60.0}},
        {"field.straw", {60.0, 200.0}, {80.0, 300.0}, {100.0, 250.0}},
        {"field.soil.tillage", {0.06, 0.12}, {0.05, 0.15}, {0.08, 0.1}},
        {"views.soil_kept", {0.82, 1.0}, {0.85, 0.95}, {0.88, 0.97}}}}};
  return all;
}

/// What a registration is told of the guess, and how wrong that is.
struct Guess {
  const char* name;
  void (*set)(Case&);
};

const std::vector<Guess>& guesses() {
  static const std::vector<Guess> all = {
      {"usual", [](Case&) {}},
      {"tight",
       [](Case& made) {
         setGuess(made.options, {0.15, 1.0, 0.01}, true);
         made.told = PriorUncertainty{.translation = 0.15, .heading_deg = 1.0, .scale = 0.01};
       }},
      {"none", forgetGuess},
      {"unit", [](Case& made) {
         forgetGuess(made);
         made.options.geotag.unknown_scale = 10.0;
         made.told.scale_unknown = true;
       }}};
  return all;
}

constexpr int kStrips = 6;  // of a field

class Builder {
 public:
  explicit Builder(const SuiteOptions& options) : options_(options) {}

  Case make(const Kind& kind, const NamedCrop& crop, const Guess& guess,
            const std::string& what) const {
    Case made =
        cropCase(fmt::format("{}{}-{}-{}-{}", prefix(), what, kind.name, guess.name, crop.name),
                 crop.crop, kPaperGuess, options_.uniform);
    made.strips_per_field = kStrips;
    made.options.field.row_spacing *= pick(options_.settings, 0.88, 1.06, 0.96);
    made.options.field.plant_spacing *= pick(options_.settings, 1.15, 0.94, 1.04);
    for (const std::vector<Drawn>* all : {&usual(), &kind.drawn}) {
      for (const Drawn& one : *all) add(one, made);
    }
    kind.change(made.options);
    guess.set(made);
    return made;
  }

 private:
  std::string prefix() const {
    return pick<std::string>(options_.settings, "dev-elsewhere-", "cal-elsewhere-", "elsewhere-");
  }
  /// A kind's own values replace the usual ones.
  void add(const Drawn& one, Case& made) const {
    std::erase_if(made.ranges, [&](const OptionRange& range) { return range.path == one.path; });
    made.ranges.push_back(one.in(options_.settings));
  }

  SuiteOptions options_;
};

}  // namespace

std::vector<Case> elsewhereCases(const SuiteOptions& options) {
  const Builder builder(options);
  std::vector<Case> cases;
  std::size_t turn = 0;
  for (const Kind& kind : kinds()) {
    for (const NamedCrop& crop : namedCrops()) {
      cases.push_back(builder.make(kind, crop, guesses().front(), "right"));
    }
    // The other ways are of one crop each, by turns.
    const auto next = [&]() -> const NamedCrop& {
      return namedCrops()[turn++ % namedCrops().size()];
    };
    for (const Guess& guess : guesses()) {
      if (&guess != &guesses().front()) {
        cases.push_back(builder.make(kind, next(), guess, "right"));
      }
      cases.push_back(builder.make(kind, next(), guess, "neg-other-field"));
      cases.back().options.other_field = true;
      cases.push_back(builder.make(kind, next(), guess, "neg-mirrored"));
      cases.back().options.mirrored = true;
    }
    ++turn;
  }
  return cases;
}

}  // namespace agricolmap::experiments
