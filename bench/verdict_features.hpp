// What the probability of being right is computed from: a few numbers that a registration measures
// on its own pair, put on scales on which a logistic regression is at home.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace agricolmap {

/// Measured on one pair.
struct VerdictNumbers {
  double uniqueness = 0.0;    ///< peak over the highest other one
  double significance = 0.0;  ///< peak over the deviation of the scores
  double agreeing = 0.0;      ///< number of blocks that, placed alone, agree
  double blocks = 0.0;        ///< number of blocks
  double block_rms = 0.0;     ///< RMS offset of the agreeing blocks [m]
  double overlap = 0.0;       ///< share of the moving map that the fixed map sees
};

inline constexpr std::size_t kVerdictFeatures = 6;
inline constexpr std::array<const char*, kVerdictFeatures> kVerdictFeatureNames = {
    "log_uniqueness",   "agreement_log_odds", "agreement_beyond_chance",
    "log_significance", "log_block_rms",      "log_overlap"};

/// Share of blocks that agree by chance: a circle of 8 cm in a square of 1 m.
inline constexpr double kChanceAgreement = 0.02;

/// Numbers outside what a pair can have are brought to its limits, NaN stays NaN.
inline std::array<double, kVerdictFeatures> verdictFeatures(const VerdictNumbers& numbers) {
  const auto logOf = [](double value, double low, double high) {
    return std::isnan(value) ? value : std::log(std::clamp(value, low, high));
  };
  const double n = std::max(1.0, numbers.blocks);
  const double k = std::clamp(numbers.agreeing, 0.0, n);
  // Twice the log-likelihood ratio of the agreeing blocks against chance, on the scale of a
  // deviation, its sign that of the excess.
  const double share = std::clamp(k / n, 1e-6, 1.0 - 1e-6);
  const double divergence = share * std::log(share / kChanceAgreement) +
                            (1.0 - share) * std::log((1.0 - share) / (1.0 - kChanceAgreement));
  const double beyond = std::sqrt(2.0 * n * std::max(0.0, divergence));
  return {logOf(numbers.uniqueness, 0.2, 20.0), std::log((k + 0.5) / (n - k + 0.5)),
          share < kChanceAgreement ? -std::log1p(beyond) : std::log1p(beyond),
          logOf(numbers.significance, 1.0, 200.0),
          // Without an agreeing block there is no offset: as bad as an offset may be.
          numbers.agreeing > 0.0 ? logOf(numbers.block_rms / 0.05, 0.02, 2.0) : std::log(2.0),
          logOf(numbers.overlap, 0.05, 1.0)};
}

}  // namespace agricolmap
