#include "agricolmap/7_verdict/probability.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap {
namespace {

/// A registration is right within this RMS displacement [m].
constexpr double kLimit = 0.05;
/// Share of blocks that agree by chance: a circle of 8 cm in one of half a metre.
constexpr double kChanceAgreement = 0.026;

// As `agricolmap_calibrate` printed them.
constexpr double kIntercept = -12.0;
constexpr VerdictFeatures kWeights = {6.0, 1.0, 0.0, 4.0, -1.0, 0.0, 0.0};

/// Logarithm of a value between its limits; the worse one for NaN.
double logWithin(double value, double low, double high, double unknown) {
  return std::log(std::isnan(value) ? unknown : std::clamp(value, low, high));
}

}  // namespace

VerdictFeatures verdictFeatures(const VerdictFacts& facts) {
  const double n = std::max(1.0, facts.blocks);
  const double k = std::clamp(facts.agreeing, 0.0, n);
  // Twice the log-likelihood ratio of the agreeing blocks against chance, on the scale of a
  // deviation, its sign that of the excess.
  const double share = std::clamp(k / n, 1e-6, 1.0 - 1e-6);
  const double divergence = share * std::log(share / kChanceAgreement) +
                            (1.0 - share) * std::log((1.0 - share) / (1.0 - kChanceAgreement));
  const double beyond = std::log1p(std::sqrt(2.0 * n * std::max(0.0, divergence)));
  const double error = std::hypot(facts.expected_rms, facts.local_rms);
  return {logWithin(facts.uniqueness, 0.3, 4.0, 0.3),
          std::log((k + 0.5) / (n - k + 0.5)),
          share < kChanceAgreement ? -beyond : beyond,
          logWithin(facts.significance, 1.0, 30.0, 1.0),
          logWithin(error / kLimit, 0.1, 10.0, 10.0),
          logWithin(facts.height_deviation / kLimit, 0.1, 10.0, 10.0),
          logWithin(facts.overlap, 0.05, 1.0, 0.05)};
}

double rightProbability(const VerdictFacts& facts) {
  const VerdictFeatures features = verdictFeatures(facts);
  double log_odds = kIntercept;
  for (std::size_t i = 0; i < features.size(); ++i) log_odds += kWeights[i] * features[i];
  return 1.0 / (1.0 + std::exp(-log_odds));
}

}  // namespace agricolmap
