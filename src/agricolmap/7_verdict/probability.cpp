#include "agricolmap/7_verdict/probability.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap {
namespace {

/// A registration is right within this RMS displacement [m].
constexpr double kLimit = 0.05;

/// Coefficients of the features, in their order.
constexpr VerdictFeatures kCoefficients = {-12.0, 6.0, 1.0, 4.0, -1.0};

}  // namespace

VerdictFeatures verdictFeatures(const VerdictFacts& facts) {
  const auto bounded = [](double value, double low, double high) {
    return std::isnan(value) ? low : std::clamp(value, low, high);
  };
  const auto agreeing = static_cast<double>(facts.agreeing);
  const double others = static_cast<double>(facts.blocks) - agreeing;
  const double error = std::hypot(facts.expected_rms, facts.local_rms);
  return {1.0, std::log(bounded(facts.uniqueness, 0.3, 4.0)),
          std::log((agreeing + 0.5) / (others + 0.5)),
          std::log(bounded(facts.significance, 1.0, 30.0)),
          std::log((std::isnan(error) ? 1.0 : std::clamp(error, 0.005, 1.0)) / kLimit)};
}

double rightProbability(const VerdictFacts& facts) {
  const VerdictFeatures features = verdictFeatures(facts);
  double log_odds = 0.0;
  for (std::size_t i = 0; i < features.size(); ++i) log_odds += kCoefficients[i] * features[i];
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace agricolmap
