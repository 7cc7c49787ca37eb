// Finding the strip without a guess and in hard views, and what must not be accepted: once with the
// settings that results are reported for, once with others, to develop on.
#include <utility>

#include "experiments/pairs/suites.hpp"

namespace agricolmap::experiments {
namespace {

/// What all cases of a suite have in common.
struct Settings {
  std::string prefix;  ///< of the cases' names
  Difference hard;
  double row_spacing;    ///< factor on the crop's
  double plant_spacing;  ///< factor on the crop's
  double length;         ///< of strips [m]
  double width;          ///< of strips [m]
};
constexpr int kStrips = 8;             // of a field of usual size
constexpr int kStripsOfLarge = 12;     // of fields that take long to make
constexpr double kLarge = 50.0;        // [m]
constexpr double kHectare = 100.0;     // [m]
constexpr double kHectareGsd = 0.016;  // flown higher

class Builder {
 public:
  Builder(Settings settings, bool uniform) : settings_(std::move(settings)), uniform_(uniform) {}

  /// Hard views, the paper's guess, 20 m x 20 m.
  Case& add(const std::string& name, simulate::Crop crop, const Target& target = {}) {
    Case made = cropCase(settings_.prefix + name, crop, kPaperGuess, uniform_, target);
    setDifference(made.options, settings_.hard);
    made.options.field.row_spacing *= settings_.row_spacing;
    made.options.field.plant_spacing *= settings_.plant_spacing;
    made.options.ugv.length = settings_.length;
    made.options.ugv.width = settings_.width;
    made.strips_per_field = kStrips;
    cases_.push_back(std::move(made));
    return cases_.back();
  }

  void addLarge() {
    for (const auto& [name, crop] : rowCrops()) {
      anywhereIn(kLarge, add("none-50m-" + name, crop,
                             {.min_success = 0.98, .max_time = 1.5, .max_refused = 0.03}));
    }
    const Target dense = {.max_rms3d = 0.03, .min_found = 0.90, .max_false = 0.0};
    anywhereIn(kLarge, add("none-50m-winter-wheat", simulate::Crop::kWinterWheat, dense));
    Case& closed = add("none-50m-closed-soybean", simulate::Crop::kSoybean, dense);
    closed.options.field.plant_size = 2.2;  // four fifths of the soil covered
    anywhereIn(kLarge, closed);
    for (const simulate::Crop crop : {simulate::Crop::kSoybean, simulate::Crop::kSugarBeet10m}) {
      Case& made =
          add("none-100m-" + namedCrop(crop).name, crop, {.min_success = 0.97, .max_time = 6.0});
      made.options.uav.gsd = kHectareGsd;
      anywhereIn(kHectare, made);
    }
    Case& real = add("semireal-none", simulate::Crop::kSugarBeet10m, {.min_success = 0.98});
    real.source = PairSource::kBeetWhole;
    // Half of the texture, nothing pulled: the other differences act on the mosaic as on plants.
    real.options.views.leaf_unshared = 0.5;
    real.strips_per_field = kStripsOfLarge;
    forgetGuess(real);
  }

  void addSmall() {
    for (const auto& [name, crop] : namedCrops()) {
      add("prior-hard-" + name, crop, {.max_rms = 0.012, .max_refused = 0.03});
    }
    for (const simulate::Crop crop :
         {simulate::Crop::kSoybean, simulate::Crop::kSugarBeet10m, simulate::Crop::kSugarBeet20m}) {
      const std::string& name = namedCrop(crop).name;
      Case& unit = add("scale-unknown-" + name, crop, {.min_success = 0.95});
      forgetGuess(unit);
      unit.options.geotag.unknown_scale = 10.0;
      unit.scale_unknown = true;
    }
    for (const simulate::Crop crop : {simulate::Crop::kSoybean, simulate::Crop::kSugarBeet10m}) {
      const std::string& name = namedCrop(crop).name;
      add("overlap-40-" + name, crop, {.max_false = 0.0}).options.ugv.overhang = 0.6;
      Case& edge = add("overlap-80-none-" + name, crop, {.min_success = 0.95});
      edge.options.ugv.overhang = 0.2;
      forgetGuess(edge);
      Case& across = add("across-rows-" + name, crop, {.min_success = 0.95});
      across.options.ugv.heading_deg = 90.0;
      forgetGuess(across);
      add("bent-" + name, crop, {.max_false = 0.0}).options.ugv.drift = 0.02;
    }
  }

  void addNegatives() {
    const Target none = {.max_accepted = 0.0};
    for (const auto& [name, crop] : namedCrops()) {
      for (const bool guess : {true, false}) {
        const std::string end = (guess ? "-" : "-none-") + name;
        add("neg-other-field" + end, crop, none).options.other_field = true;
        if (!guess) forgetGuess(cases_.back());
        add("neg-no-overlap" + end, crop, none).options.beyond_map = true;
        if (!guess) forgetGuess(cases_.back());
        add("neg-mirrored" + end, crop, none).options.mirrored = true;
        if (!guess) forgetGuess(cases_.back());
      }
      shiftByRows(add("neg-row-shift-" + name, crop, {.max_false = 0.0}));
    }
    for (const auto& [name, crop] : namedCrops()) {
      for (const bool guess : {true, false}) {
        Case& grown =
            add((guess ? "neg-growth-" : "neg-growth-none-") + name, crop, {.max_false = 0.0});
        grown.options.views.growth = 2.5;
        grown.options.views.wind = 0.03;
        grown.options.views.leaf_unshared = 1.0;
        if (!guess) forgetGuess(grown);
      }
    }
  }

  std::vector<Case> take() { return std::move(cases_); }

 private:
  static void anywhereIn(double size, Case& made) {
    made.options.field.width = size;
    made.options.field.height = size;
    made.strips_per_field = kStripsOfLarge;
    forgetGuess(made);
  }

  Settings settings_;
  bool uniform_;
  std::vector<Case> cases_;
};

std::vector<Case> build(const Settings& settings, bool uniform) {
  Builder builder(settings, uniform);
  builder.addLarge();
  builder.addSmall();
  builder.addNegatives();
  return builder.take();
}

}  // namespace

std::vector<Case> locateSuite(bool uniform) {
  return build({"", kHardViews, 1.0, 1.0, 10.0, 2.2}, uniform);
}

std::vector<Case> developSuite(bool uniform) {
  return build({"dev-", {0.55, 0.025, 1.25, 3.0, 0.4, 0.009}, 0.92, 1.1, 9.5, 2.1}, uniform);
}

}  // namespace agricolmap::experiments
