// The first campaign: the paper's crops and errors of the guess, strips of other fields, real
// imagery.
#include <utility>

#include "experiments/pairs/suite_parts.hpp"

namespace agricolmap::experiments {
namespace {

Case beetMosaicCase(bool uniform) {
  Case made =
      cropCase("semireal-sugarbeet", simulate::Crop::kSugarBeet10m, {3.0, 6.0, 0.15}, uniform);
  useImagery(made, PairSource::kBeetMosaic, "semireal-sugarbeet");
  return made;
}

Case soybeanCase(bool uniform) {
  Case made = cropCase("real-soybean", simulate::Crop::kSoybean, {1.0, 3.0, 0.10}, uniform);
  useImagery(made, PairSource::kSoybean, "real-soybean");
  made.max_pairs = 10;
  // The plot is 11.4 m x 5.6 m. Its plants are as they were at the flight: what differs is the
  // sampling, the noise, the colours and the path.
  made.options.ugv.length = 6.0;
  made.options.ugv.width = 2.0;
  made.options.views.leaf_unshared = 0.0;
  made.options.views.wind = 0.0;
  made.options.views.growth = 1.0;
  made.options.geotag.utm = false;
  return made;
}

}  // namespace

std::vector<Case> paperCases(const SuiteOptions& options) {
  std::vector<NamedCrop> crops = namedCrops();
  crops.pop_back();  // maize is not among the paper's
  const bool uniform = options.uniform;
  std::vector<Case> cases;
  for (const auto& [name, crop] : crops) {
    cases.push_back(cropCase(name + "-easy", crop, kEasyGuess, uniform));
  }
  for (const auto& [name, crop] : crops) {
    cases.push_back(cropCase(name + "-joint", crop, kPaperGuess, uniform));
  }
  cases.push_back(cropCase("maize-joint", simulate::Crop::kMaize, kPaperGuess, uniform));
  for (const auto& [name, crop] : crops) {
    cases.push_back(cropCase("other-field-" + name, crop, kPaperGuess, uniform));
    cases.back().options.other_field = true;
  }
  cases.push_back(beetMosaicCase(uniform));
  cases.push_back(soybeanCase(uniform));
  return cases;
}

}  // namespace agricolmap::experiments
