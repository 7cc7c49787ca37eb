// The weights in the program are those of the committed calibration.
#include "agricolmap/verdict/probability.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "agricolmap/core/random.hpp"

namespace agricolmap::verdict {
namespace {

nlohmann::json calibration(const std::string& about) {
  std::ifstream file(AGRICOLMAP_CALIBRATION_DIR "/" + about + "/calibration.json");
  return nlohmann::json::parse(file);
}

double logOdds(const nlohmann::json& calibration, const VerdictFeatures& features) {
  double sum = calibration["intercept"].get<double>();
  for (std::size_t i = 0; i < features.size(); ++i) {
    sum += calibration["weights"].at(kVerdictFeatureNames[i]).get<double>() * features[i];
  }
  return sum;
}

double logOdds(double probability) { return std::log(probability) - std::log1p(-probability); }

/// Facts between what nothing speaks for and what is nearly certain, where log odds keep digits.
VerdictFacts drawFacts(Random& random) {
  const double blocks = std::round(random.uniform(4.0, 30.0));
  return {.uniqueness = random.uniform(0.8, 4.0),
          .significance = random.uniform(3.0, 25.0),
          .agreeing = std::round(blocks * random.uniform()),
          .blocks = blocks,
          .expected_rms = random.uniform(0.005, 0.1),
          .local_rms = random.uniform(0.005, 0.1),
          .height_deviation = random.uniform(0.005, 0.2),
          .overlap = random.uniform(0.1, 1.0)};
}

TEST(Probability, WeightsAreThoseOfTheCommittedCalibration) {
  const nlohmann::json space = calibration("space");
  const nlohmann::json plane = calibration("plane");
  // As printed with four digits, of features of up to about 4 each.
  constexpr double kPrinted = 7 * 4.0 * 5e-5 + 5e-5;
  Random random(3);
  int told_apart = 0;
  for (int i = 0; i < 1000; ++i) {
    const VerdictFacts facts = drawFacts(random);
    const VerdictFeatures features = verdictFeatures(facts);
    const double in_space = logOdds(space, features);
    const double in_plane = logOdds(plane, features);
    EXPECT_NEAR(logOdds(rightProbability(facts)), in_space, kPrinted);
    EXPECT_NEAR(logOdds(planeProbability(facts)), std::max(in_space, in_plane), kPrinted);
    told_apart += in_plane > in_space + 0.1 ? 1 : 0;
  }
  EXPECT_GT(told_apart, 500);
}

}  // namespace
}  // namespace agricolmap::verdict
