// Finding the strip without a guess and in hard views, and what must not be accepted: once with the
// settings that results are reported for, once with others, to develop on.
#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

/// What all cases of a suite have in common.
struct Layout {
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
  Builder(Layout layout, bool uniform) : layout_(std::move(layout)), uniform_(uniform) {}

  /// Hard views, the paper's guess, 20 m x 20 m.
  Case& add(const std::string& name, simulate::Crop crop) {
    Case made = cropCase(layout_.prefix + name, crop, kPaperGuess, uniform_);
    setDifference(made.options, layout_.hard);
    made.options.field.row_spacing *= layout_.row_spacing;
    made.options.field.plant_spacing *= layout_.plant_spacing;
    made.options.ugv.length = layout_.length;
    made.options.ugv.width = layout_.width;
    made.strips_per_field = kStrips;
    cases_.push_back(std::move(made));
    return cases_.back();
  }

  void addLarge() {
    for (const auto& [name, crop] : rowCrops()) {
      anywhereIn(kLarge, add("none-50m-" + name, crop));
    }
    anywhereIn(kLarge, add("none-50m-winter-wheat", simulate::Crop::kWinterWheat));
    Case& closed = add("none-50m-closed-soybean", simulate::Crop::kSoybean);
    closed.options.field.plant_size = 2.2;  // four fifths of the soil covered
    anywhereIn(kLarge, closed);
    for (const simulate::Crop crop : {simulate::Crop::kSoybean, simulate::Crop::kSugarBeet10m}) {
      Case& made = add("none-100m-" + nameOf(crop), crop);
      made.options.uav.gsd = kHectareGsd;
      anywhereIn(kHectare, made);
    }
    Case& real = add("semireal-none", simulate::Crop::kSugarBeet10m);
    useImagery(real, PairSource::kBeetWhole, "semireal-sugarbeet");
    // Half of the texture, nothing pulled: the other differences act on the mosaic as on plants.
    real.options.views.leaf_unshared = 0.5;
    real.strips_per_field = kStripsOfLarge;
    forgetGuess(real);
  }

  void addSmall() {
    for (const auto& [name, crop] : namedCrops()) {
      add("prior-hard-" + name, crop);
    }
    for (const simulate::Crop crop :
         {simulate::Crop::kSoybean, simulate::Crop::kSugarBeet10m, simulate::Crop::kSugarBeet20m}) {
      const std::string& name = nameOf(crop);
      Case& unit = add("scale-unknown-" + name, crop);
      forgetGuess(unit);
      unit.options.geotag.unknown_scale = 10.0;
      unit.told.scale_unknown = true;
    }
    for (const simulate::Crop crop : {simulate::Crop::kSoybean, simulate::Crop::kSugarBeet10m}) {
      const std::string& name = nameOf(crop);
      add("overlap-40-" + name, crop).options.ugv.overhang = 0.6;
      Case& edge = add("overlap-80-none-" + name, crop);
      edge.options.ugv.overhang = 0.2;
      forgetGuess(edge);
      Case& across = add("across-rows-" + name, crop);
      across.options.ugv.heading_deg = 90.0;
      forgetGuess(across);
      add("bent-" + name, crop).options.ugv.drift = 0.02;
    }
  }

  void addNegatives() {
    for (const auto& [name, crop] : namedCrops()) {
      for (const bool guess : {true, false}) {
        const std::string end = (guess ? "-" : "-none-") + name;
        add("neg-other-field" + end, crop).options.other_field = true;
        if (!guess) forgetGuess(cases_.back());
        add("neg-no-overlap" + end, crop).options.beyond_map = true;
        if (!guess) forgetGuess(cases_.back());
        add("neg-mirrored" + end, crop).options.mirrored = true;
        if (!guess) forgetGuess(cases_.back());
      }
      shiftByRows(add("neg-row-shift-" + name, crop));
    }
    for (const auto& [name, crop] : namedCrops()) {
      for (const bool guess : {true, false}) {
        Case& grown = add((guess ? "neg-growth-" : "neg-growth-none-") + name, crop);
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

  Layout layout_;
  bool uniform_;
  std::vector<Case> cases_;
};

}  // namespace

std::vector<Case> locateCases(const SuiteOptions& options) {
  Layout layout = {"", kHardViews, 1.0, 1.0, 10.0, 2.2};
  if (options.settings == Settings::kDevelop) {
    layout = {"dev-", {0.55, 0.025, 1.25, 3.0, 0.4, 0.009}, 0.92, 1.1, 9.5, 2.1};
  }
  Builder builder(layout, options.uniform);
  builder.addLarge();
  builder.addSmall();
  builder.addNegatives();
  return builder.take();
}

}  // namespace agricolmap::experiments
