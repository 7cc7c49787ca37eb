#include "agricolmap/verdict/probability.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::verdict {
namespace {

/// A registration is right within this RMS displacement [m].
constexpr double kLimit = 0.05;
/// Share of blocks that agree by chance: a circle of 8 cm in one of half a metre.
constexpr double kChanceAgreement = 0.026;

/// A fitted model.
struct Model {
  double intercept;
  VerdictFeatures weights;
};
// Of docs/results/calibration/{space,plane}/calibration.json; a test compares them.
constexpr Model kAll = {-19.0314, {3.5448, 0.1172, 0.0000, 4.2849, -1.4576, -7.4809, 3.7044}};
constexpr Model kPlane = {-10.9878, {4.9948, 0.1509, 0.1347, 3.3235, -1.6839, 0.0000, 1.0622}};

double probabilityOf(const VerdictFacts& facts, const Model& model) {
  const VerdictFeatures features = verdictFeatures(facts);
  double log_odds = model.intercept;
  for (std::size_t i = 0; i < features.size(); ++i) log_odds += model.weights[i] * features[i];
  return 1.0 / (1.0 + std::exp(-log_odds));
}

/// Logarithm of a value between its limits; the worse one for NaN.
double logWithin(double value, double low, double high, double unknown) {
  return std::log(std::isnan(value) ? unknown : std::clamp(value, low, high));
}

}  // namespace

VerdictFeatures verdictFeatures(const VerdictFacts& facts) {
  // Comparisons that NaN fails.
  const double n = facts.blocks >= 1.0 ? std::min(facts.blocks, 1e6) : 1.0;
  const double k = facts.agreeing >= 0.0 ? std::min(facts.agreeing, n) : 0.0;
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

double rightProbability(const VerdictFacts& facts) { return probabilityOf(facts, kAll); }

// What is right in space is right in the plane: fitted apart, the two may say otherwise.
double planeProbability(const VerdictFacts& facts) {
  return std::max(probabilityOf(facts, kPlane), rightProbability(facts));
}

}  // namespace agricolmap::verdict
