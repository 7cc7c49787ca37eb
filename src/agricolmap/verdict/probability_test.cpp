// The weights in the program are those of the committed calibration.
#include "agricolmap/verdict/probability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "agricolmap/core/random.hpp"

namespace agricolmap::verdict {
namespace {

double logOdds(double probability) { return std::log(probability) - std::log1p(-probability); }

/// Facts between what nothing speaks for and what is nearly certain, where log odds keep digits.
VerdictFacts drawFacts(Random& random) {
  const double blocks = std::round(random.uniform(4.0, 30.0));
  return {.uniqueness = random.uniform(0.8, 4.0),
          .significance = random.uniform(3.0, 25.0),
          .decoy = random.uniform(0.8, 4.0),
          .agreeing = std::round(blocks * random.uniform()),
          .blocks = blocks,
          .expected_rms = random.uniform(0.005, 0.1),
          .local_rms = random.uniform(0.005, 0.1),
          .overlap = random.uniform(0.1, 1.0)};
}

TEST(Probability, WeightsAreThoseOfTheCommittedCalibration) {
  std::ifstream file(AGRICOLMAP_CALIBRATION_DIR "/calibration.json");
  const nlohmann::json calibration = nlohmann::json::parse(file);
  // As printed with four digits, of features of up to about 4 each.
  constexpr double kPrinted = 6 * 4.0 * 5e-5 + 5e-5;
  Random random(3);
  for (int i = 0; i < 1000; ++i) {
    const VerdictFacts facts = drawFacts(random);
    const VerdictFeatures features = verdictFeatures(facts);
    double sum = calibration["intercept"].get<double>();
    for (std::size_t k = 0; k < features.size(); ++k) {
      sum += calibration["weights"].at(kVerdictFeatureNames[k]).get<double>() * features[k];
    }
    EXPECT_NEAR(logOdds(placeProbability(facts)), sum, kPrinted);
  }
}

TEST(Probability, AStatedErrorAboveTheLimitIsNeverWithinIt) {
  VerdictFacts facts{.uniqueness = 4.0,
                     .significance = 30.0,
                     .decoy = 6.0,
                     .agreeing = 16.0,
                     .blocks = 16.0,
                     .expected_rms = 0.005,
                     .local_rms = 0.005,
                     .overlap = 1.0};
  EXPECT_GT(planeProbability(facts), 0.95);
  facts.expected_rms = 0.06;
  EXPECT_LT(planeProbability(facts), 0.5);
  facts.expected_rms = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(planeProbability(facts), 0.0);
}

}  // namespace
}  // namespace agricolmap::verdict
