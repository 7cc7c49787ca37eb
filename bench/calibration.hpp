// Fits the verdict's probability to the rows of campaigns and says how well it holds.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "campaign_table.hpp"
#include "logistic.hpp"

namespace agricolmap::campaign {

/// Answers with all their numbers, and what else the rows hold.
struct CalibrationSamples {
  Eigen::MatrixXd features;  ///< a row of verdictFeatures for each answer
  Eigen::VectorXd right;     ///< 1 within 5 cm RMS, 0 else
  std::vector<int> field;    ///< seeds of the fields
  std::vector<std::string> cases;
  std::size_t without_answer = 0;    ///< rows that have no transform
  std::size_t solvable_without = 0;  ///< of these, pairs that have a right answer
};

/// Right means RMS displacement of the points within this [m].
inline constexpr double kRightRms = 0.05;

/// What is to be right: the whole displacement, or its horizontal part, on which heights say
/// nothing.
enum class RightAbout { kAll, kPlane };

/// The answers among the rows; `preset` empty: of all presets.
CalibrationSamples samplesOf(const std::vector<PairRow>& rows, const std::string& preset,
                             RightAbout about = RightAbout::kAll);

/// What each answer is said to be by a model fitted to the other folds; a field is in one fold
/// only, whatever its case.
std::vector<Statement> crossValidate(const CalibrationSamples& samples, int folds, double ridge);
/// What a model says about samples.
std::vector<Statement> statementsOf(const CalibrationSamples& samples, const LogisticModel& model);
/// kVerdictFeatureSigns as numbers.
Eigen::VectorXd featureSigns();

/// What one set of statements is worth.
struct CalibrationQuality {
  std::size_t answers = 0;
  std::size_t right = 0;
  double area_under_curve = 0.0;
  double error_equal_mass = 0.0;
  double error_equal_width = 0.0;
  double brier = 0.0;
  std::vector<ReliabilityBin> bins;
};
CalibrationQuality qualityOf(const std::vector<Statement>& statements);

/// Answers accepted though wrong, and right ones refused, at a threshold.
struct ThresholdCount {
  std::size_t wrong_accepted = 0;
  std::size_t right_refused = 0;
  std::size_t right = 0;
};
ThresholdCount countAt(const std::vector<Statement>& statements, double threshold);

/// All that a calibration comes to.
struct Calibration {
  std::string origin;  ///< of the rows, a line for each file
  LogisticModel model;
  AcceptThreshold threshold;                            ///< from the cross-validated statements
  std::map<std::string, CalibrationQuality> qualities;  ///< "fit", "cross-validation", "test"
  std::map<std::string, ThresholdCount> counts;         ///< at the threshold, of the same
  std::size_t without_answer = 0;
  std::size_t solvable_without = 0;
};

std::string calibrationText(const Calibration& calibration);
std::string calibrationJson(const Calibration& calibration);
/// The reliability diagram: a line per set and bin.
std::string reliabilityCsv(const Calibration& calibration);

}  // namespace agricolmap::campaign
