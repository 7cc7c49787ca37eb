// The probability that a registration is right, from its evidence: a logistic regression whose
// weights `experiments/calibrate` finds on pairs with known truth (docs/campaign-suites.md).
#pragma once

#include <array>
#include <cstddef>

namespace agricolmap::verdict {

/// What the probability rests on, as plain numbers. NaN stands for what is not known, and counts
/// as badly as it can.
struct VerdictFacts {
  double uniqueness = 0.0;    ///< see Evidence
  double significance = 0.0;  ///< see Evidence
  double agreeing = 0.0;      ///< blocks
  double blocks = 0.0;
  double expected_rms = 0.0;      ///< see PoseUncertainty [m]
  double local_rms = 0.0;         ///< see PoseUncertainty [m]
  double height_deviation = 0.0;  ///< see PoseUncertainty [m]
  double overlap = 0.0;           ///< share of the moving map that the fixed map sees
};

inline constexpr std::size_t kVerdictFeatures = 7;
using VerdictFeatures = std::array<double, kVerdictFeatures>;
inline constexpr std::array<const char*, kVerdictFeatures> kVerdictFeatureNames = {
    "log_uniqueness",   "agreement_log_odds", "agreement_beyond_chance",
    "log_significance", "log_plane_error",    "log_height_error",
    "log_overlap"};

/// The facts on scales on which a logistic regression is at home; each within bounds, so that no
/// single one decides alone.
VerdictFeatures verdictFeatures(const VerdictFacts& facts);

/// Of being within 5 cm RMS of the truth, 0…1.
double rightProbability(const VerdictFacts& facts);
/// Of its horizontal part being so: the right row and the right plant, whatever the height.
double planeProbability(const VerdictFacts& facts);

}  // namespace agricolmap::verdict
