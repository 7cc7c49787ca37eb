// What the suites of cases are put together from.
#pragma once

#include <string>
#include <vector>

#include "experiments/pairs/cases.hpp"

namespace agricolmap::experiments {

struct NamedCrop {
  std::string name;
  simulate::Crop crop;
};
/// soybean, sugar-beet-10m, sugar-beet-20m, winter-wheat, maize.
const std::vector<NamedCrop>& namedCrops();
/// The same without the drilled cereal, whose rows are too narrow to be told apart.
std::vector<NamedCrop> rowCrops();
const NamedCrop& namedCrop(simulate::Crop crop);

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
Case cropCase(std::string name, simulate::Crop crop, const GuessError& error, bool uniform,
                      const Target& target = {});
/// Makes the guess useless and says so: any position and heading, scales within 30 %.
void forgetGuess(Case& made);
/// Makes the guess wrong by about half a metre across the rows, a whole number of them, and the
/// registration trust it to 0.3 m: what looks right is not.
void shiftByRows(Case& made);

std::vector<Case> paperSuite(bool uniform);
std::vector<Case> locateSuite(bool uniform);
std::vector<Case> developSuite(bool uniform);
std::vector<Case> curvesSuite(bool uniform);
std::vector<Case> calibrateSuite(bool uniform);

}  // namespace agricolmap::experiments
