// The suites: which pairs are registered, from which guesses.
#pragma once

#include <string>
#include <vector>

#include "experiments/pairs/cases.hpp"
#include "experiments/pairs/guess.hpp"

namespace agricolmap::experiments {

/// Disjoint ways in which pairs may differ: what methods are improved on and what the verdict's
/// probability is fitted to is not what is reported.
enum class Settings { kDevelop, kCalibrate, kFinal };
std::string toString(Settings settings);
/// Throws UsageError, listing the known names, for an unknown one.
Settings parseSettings(const std::string& name);

/// Guesses of which one error rises and all else stays.
struct Curve {
  double scale = 0.0;  ///< of all its guesses; 0 where the scale itself rises
  bool rising = true;  ///< false: guesses that have no order
  std::vector<AddedError> errors;
};

struct Suite {
  std::string name;
  Settings settings = Settings::kFinal;
  std::vector<Case> cases;
  /// Errors added to the cases' guesses, which then are exact; empty: guesses as the cases have
  /// them.
  std::vector<Curve> curves = {};
  bool matching_only = false;  ///< for methods that match points
  int pairs = 60;              ///< of each case, unless asked otherwise
  int first_seed = 5001;       ///< of the pairs, likewise
};

struct SuiteOptions {
  Settings settings = Settings::kFinal;
  bool uniform =
      false;           ///< errors of a case's own guess from zero to its limit, not always as large
  bool quick = false;  ///< small fields, short strips, few guesses: minutes
};

/// "paper": the paper's crops, other fields, real imagery; "locate": no guess, hard views and what
/// must not be accepted; "curves": one setting varied at a time; "bends": drift and slips;
/// "elsewhere-sim": what real flights have and the crops' presets have not; "heights": canopies,
/// ridges and slopes; "long", "terrain": what their names say; "translation",
/// "heading", "joint", "accuracy", "inliers": drawn views from guesses of known error.
/// docs/campaign-suites.md says which settings each has.
std::vector<std::string> suiteNames();
std::vector<Settings> settingsOf(const std::string& suite);
/// Throws UsageError for an unknown suite, and for settings that it does not have.
Suite makeSuite(const std::string& name, const SuiteOptions& options);

}  // namespace agricolmap::experiments
