// The probability that a registration is right in the plane: that it is the right place, from the
// evidence, times that of being within 5 cm there, from the errors that it states of itself.
// Heights have a verdict of their own (heights.hpp).
//
// The first is a logistic regression whose weights `experiments/calibrate` finds on pairs with
// known truth (docs/campaign-suites.md); the second follows from the stated errors, so that the two
// can not contradict one another.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace agricolmap::verdict {

/// What the probability rests on, as plain numbers. NaN stands for what is not known, and counts
/// as badly as it can.
struct VerdictFacts {
  double uniqueness = 0.0;    ///< see Evidence
  double significance = 0.0;  ///< see Evidence
  double decoy = 0.0;         ///< significance over that of the best decoy
  double agreeing = 0.0;      ///< blocks
  double blocks = 0.0;
  double expected_rms = 0.0;  ///< see PoseUncertainty [m]
  double local_rms = 0.0;     ///< see PoseUncertainty [m]
  double overlap = 0.0;       ///< share of the moving map that the fixed map sees
};

inline constexpr std::size_t kVerdictFeatures = 6;
using VerdictFeatures = std::array<double, kVerdictFeatures>;
inline constexpr std::array<const char*, kVerdictFeatures> kVerdictFeatureNames = {
    "log_uniqueness",          "log_decoy",        "agreement_log_odds",
    "agreement_beyond_chance", "log_significance", "log_overlap"};

/// The facts that tell places apart, on scales on which a logistic regression is at home; each
/// within bounds, so that no single one decides alone. More of any speaks for the registration.
VerdictFeatures verdictFeatures(const VerdictFacts& facts);

/// Of being the right place, 0…1: the right row and the right plant.
double placeProbability(const VerdictFacts& facts);
/// Of being within 5 cm RMS of the truth in the plane, whatever the height.
double planeProbability(const VerdictFacts& facts);

/// A probability in words: nothing is certain.
std::string percentOf(double probability);

}  // namespace agricolmap::verdict
