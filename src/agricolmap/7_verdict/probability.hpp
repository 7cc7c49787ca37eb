// The probability that a registration is right, from its evidence: a logistic regression whose
// coefficients `agricolmap_calibrate` finds on pairs with known truth.
#pragma once

#include <array>
#include <cstddef>

namespace agricolmap {

/// What the probability rests on, as plain numbers.
struct VerdictFacts {
  double uniqueness = 0.0;    ///< see Evidence
  double significance = 0.0;  ///< see Evidence
  std::size_t agreeing = 0;   ///< blocks
  std::size_t blocks = 0;
  double expected_rms = 0.0;  ///< see PoseUncertainty [m]; infinite when it is not known
  double local_rms = 0.0;     ///< see PoseUncertainty [m]; infinite when it is not known
};

inline constexpr std::size_t kVerdictFeatures = 5;
using VerdictFeatures = std::array<double, kVerdictFeatures>;

/// 1, log uniqueness, log odds of a block agreeing, log significance, and log of the expected error
/// over the limit of 5 cm; each within bounds, so that no single one decides alone.
VerdictFeatures verdictFeatures(const VerdictFacts& facts);

/// Within 5 cm RMS of the truth, 0…1.
double rightProbability(const VerdictFacts& facts);

}  // namespace agricolmap
