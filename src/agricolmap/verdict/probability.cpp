#include "agricolmap/verdict/probability.hpp"

#include <fmt/format.h>

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
// Of docs/results/calibration/calibration.json; a test compares them.
constexpr Model kPlace = {-5.9017, {4.2155, 2.1580, 0.4615, 0.9921, 1.3712, 2.0562}};

/// Logarithm of a value between its limits; the worse one for NaN.
double logWithin(double value, double low, double high, double unknown) {
  return std::log(std::isnan(value) ? unknown : std::clamp(value, low, high));
}

/// Of a root mean square error over a strip being within the limit, when `expected` [m] is what it
/// comes to on average: a shift, a turn and two stretches make it, of which about four count alike.
double withinLimit(double expected) {
  if (!(expected >= 0.0)) return 0.0;
  const double ratio = kLimit / std::max(expected, 1e-6);
  const double half = 2.0 * ratio * ratio;  // of a chi-square variable of four degrees of freedom
  return 1.0 - std::exp(-half) * (1.0 + half);
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
  return {
      logWithin(facts.uniqueness, 0.3, 4.0, 0.3),    logWithin(facts.decoy, 0.3, 4.0, 0.3),
      std::log((k + 0.5) / (n - k + 0.5)),           share < kChanceAgreement ? -beyond : beyond,
      logWithin(facts.significance, 1.0, 30.0, 1.0), logWithin(facts.overlap, 0.05, 1.0, 0.05)};
}

double placeProbability(const VerdictFacts& facts) {
  const VerdictFeatures features = verdictFeatures(facts);
  double log_odds = kPlace.intercept;
  for (std::size_t i = 0; i < features.size(); ++i) log_odds += kPlace.weights[i] * features[i];
  return 1.0 / (1.0 + std::exp(-log_odds));
}

double planeProbability(const VerdictFacts& facts) {
  return placeProbability(facts) * withinLimit(std::hypot(facts.expected_rms, facts.local_rms));
}

std::string percentOf(double probability) {
  if (probability > 0.9995) return "> 99.9 %";
  if (probability < 0.0005) return "< 0.1 %";
  return fmt::format("{:.1f} %", 100.0 * probability);
}

}  // namespace agricolmap::verdict
