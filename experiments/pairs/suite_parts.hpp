// What the suites of cases are put together from.
#pragma once

#include <string>
#include <vector>

#include "experiments/pairs/suite.hpp"

namespace agricolmap::experiments {

struct NamedCrop {
  std::string name;
  simulate::Crop crop;
};
/// soybean, sugar-beet-10m, sugar-beet-20m, winter-wheat, maize.
const std::vector<NamedCrop>& namedCrops();
/// The same without the drilled cereal, whose rows are too narrow to be told apart.
std::vector<NamedCrop> rowCrops();
const std::string& nameOf(simulate::Crop crop);

/// How wrong the initial guess is.
struct GuessError {
  double translation;  ///< [m]
  double heading_deg;
  double scale;
};
inline constexpr GuessError kEasyGuess = {1.0, 2.0, 0.05};
inline constexpr GuessError kPaperGuess = {5.0, 11.5, 0.30};
void setGuess(simulate::SimulationOptions& options, const GuessError& error, bool uniform);

/// How much the two visits differ.
struct Difference {
  double leaf_unshared;
  double wind;    ///< [m]
  double growth;  ///< factor
  double sun_hours;
  double weeds_pulled;
  double drift;
};
/// The hard views of the project's target.
inline constexpr Difference kHardViews = {0.6, 0.03, 1.3, 4.0, 0.5, 0.01};
void setDifference(simulate::SimulationOptions& options, const Difference& difference);

/// A case of the crop's preset with the guess's error.
Case cropCase(std::string name, simulate::Crop crop, const GuessError& error, bool uniform);
/// Cuts the case's strips from real imagery. `dataset` names it.
void useImagery(Case& made, PairSource source, std::string dataset);
/// Makes the guess useless and says so: any position and heading, scales within 30 %.
void forgetGuess(Case& made);
/// Makes the guess wrong by about half a metre across the rows, a whole number of them, and the
/// registration trust it to 0.3 m: what looks right is not.
void shiftByRows(Case& made);
/// A small field and a short strip of it.
void shrink(Case& made);

/// What stands in the settings that pairs may be of; no two should have a value in common.
template <typename Value>
Value pick(Settings settings, const Value& develop, const Value& calibrate, const Value& final) {
  if (settings == Settings::kDevelop) return develop;
  return settings == Settings::kCalibrate ? calibrate : final;
}

/// One option's values in each of the settings, drawn from for each pair.
struct Drawn {
  const char* path;
  std::vector<double> develop;
  std::vector<double> calibrate;
  std::vector<double> final;

  OptionRange in(Settings settings) const {
    return {path, 0.0, 0.0, pick(settings, develop, calibrate, final)};
  }
};

std::vector<Case> paperCases(const SuiteOptions& options);
std::vector<Case> locateCases(const SuiteOptions& options);  ///< of kFinal and kDevelop
std::vector<Case> calibrateCases(const SuiteOptions& options);
std::vector<Case> curvesCases(const SuiteOptions& options);
std::vector<Case> dateCases(const SuiteOptions& options);
std::vector<Case> mirroredDateCases(const SuiteOptions& options);
std::vector<Case> slipCases(const SuiteOptions& options);
/// Strips that drift has bent, of 10 and 20 m, and some that slipped twice; of all settings.
std::vector<Case> bendCases(const SuiteOptions& options);
std::vector<Case> otherGeneratorCases(const SuiteOptions& options);
std::vector<Case> elsewhereCases(const SuiteOptions& options);  ///< of all settings
std::vector<Case> longCases(const SuiteOptions& options);       ///< of all settings
std::vector<Case> terrainCases(const SuiteOptions& options);    ///< of all settings
std::vector<Case> heightsCases(const SuiteOptions& options);    ///< likewise
/// The paper's four fields and two real ones in drawn views, guesses exact.
std::vector<Case> viewCases(const SuiteOptions& options);
/// The guesses of a suite on viewCases, by its name.
std::vector<Curve> curvesOf(const std::string& suite, bool quick);

}  // namespace agricolmap::experiments
