#include "calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "agricolmap/verdict/probability.hpp"

namespace agricolmap::campaign {
namespace {

verdict::VerdictFacts factsOf(const PairRow& row) {
  return {.uniqueness = row.uniqueness,
          .significance = row.significance,
          .agreeing = std::round(row.agreement * row.blocks),
          .blocks = row.blocks,
          .expected_rms = row.expected_rms,
          .local_rms = row.local_rms,
          .height_deviation = row.height_deviation,
          .overlap = row.overlap};
}

}  // namespace

CalibrationSamples samplesOf(const std::vector<PairRow>& rows, const std::string& preset,
                             RightAbout about) {
  CalibrationSamples samples;
  std::vector<std::array<double, verdict::kVerdictFeatures>> found;
  std::vector<double> right;
  for (const PairRow& row : rows) {
    if (!preset.empty() && row.preset != preset) continue;
    verdict::VerdictFeatures features = verdict::verdictFeatures(factsOf(row));
    if (about == RightAbout::kPlane) features[verdict::kHeightFeature] = 0.0;
    if (!std::isfinite(row.errors.rms) || !std::isfinite(row.uniqueness)) {
      ++samples.without_answer;
      samples.solvable_without += row.negative ? 0 : 1;
      continue;
    }
    found.push_back(features);
    const double rms = about == RightAbout::kPlane ? row.errors.rms_horizontal : row.errors.rms;
    right.push_back(!row.negative && rms <= kRightRms ? 1.0 : 0.0);
    samples.field.push_back(row.field);
    samples.cases.push_back(row.case_name);
  }
  const auto n = static_cast<Eigen::Index>(found.size());
  samples.features.resize(n, verdict::kVerdictFeatures);
  samples.right.resize(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    samples.right(i) = right[static_cast<std::size_t>(i)];
    samples.features.row(i) = Eigen::Map<const Eigen::RowVectorXd>(
        found[static_cast<std::size_t>(i)].data(), verdict::kVerdictFeatures);
  }
  return samples;
}

Eigen::VectorXd featureSigns() {
  Eigen::VectorXd signs(verdict::kVerdictFeatures);
  for (std::size_t i = 0; i < verdict::kVerdictFeatures; ++i) {
    signs(static_cast<Eigen::Index>(i)) = verdict::kVerdictFeatureSigns[i];
  }
  return signs;
}

std::vector<Statement> statementsOf(const CalibrationSamples& samples, const LogisticModel& model) {
  std::vector<Statement> statements;
  for (Eigen::Index i = 0; i < samples.features.rows(); ++i) {
    statements.push_back(
        {model.probability(samples.features.row(i).transpose()), samples.right(i) > 0.5});
  }
  return statements;
}

std::vector<Statement> crossValidate(const CalibrationSamples& samples, int folds, double ridge) {
  const std::set<int> fields(samples.field.begin(), samples.field.end());
  std::map<int, int> fold_of;
  for (const int field : fields) {
    fold_of.emplace(field, static_cast<int>(fold_of.size()) % folds);
  }
  std::vector<Statement> statements(samples.field.size());
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<Eigen::Index> rest;
    std::vector<Eigen::Index> left_out;
    for (std::size_t i = 0; i < samples.field.size(); ++i) {
      (fold_of[samples.field[i]] == fold ? left_out : rest).push_back(static_cast<Eigen::Index>(i));
    }
    if (left_out.empty()) continue;
    const LogisticModel model =
        fitLogistic(samples.features(rest, Eigen::all), samples.right(rest), ridge, featureSigns());
    for (const Eigen::Index i : left_out) {
      statements[static_cast<std::size_t>(i)] = {
          model.probability(samples.features.row(i).transpose()), samples.right(i) > 0.5};
    }
  }
  return statements;
}

CalibrationQuality qualityOf(const std::vector<Statement>& statements) {
  CalibrationQuality quality;
  quality.answers = statements.size();
  for (const Statement& one : statements) quality.right += one.right ? 1 : 0;
  quality.area_under_curve = areaUnderCurve(statements);
  quality.error_equal_mass = calibrationError(statements, true);
  quality.error_equal_width = calibrationError(statements, false);
  quality.brier = brierScore(statements);
  quality.bins = reliability(statements);
  return quality;
}

ThresholdCount countAt(const std::vector<Statement>& statements, double threshold) {
  ThresholdCount count;
  for (const Statement& one : statements) {
    count.right += one.right ? 1 : 0;
    if (one.right && one.probability < threshold) ++count.right_refused;
    if (!one.right && one.probability >= threshold) ++count.wrong_accepted;
  }
  return count;
}

std::string calibrationText(const Calibration& calibration) {
  std::string text = calibration.origin + "\n";
  text += fmt::format("{:28} {:10.4f}\n", "intercept", calibration.model.intercept);
  for (std::size_t k = 0; k < verdict::kVerdictFeatures; ++k) {
    text += fmt::format("{:28} {:10.4f}\n", verdict::kVerdictFeatureNames[k],
                        calibration.model.weights(static_cast<Eigen::Index>(k)));
  }
  text += fmt::format("\nrows without an answer: {}, {} of them of solvable pairs\n",
                      calibration.without_answer, calibration.solvable_without);
  text += fmt::format(
      "accept from {:.4f} on (highest wrong one, cross-validated: {:.4f}): {} of {} right answers "
      "refused\n\n",
      calibration.threshold.probability, calibration.threshold.highest_wrong,
      calibration.threshold.refused, calibration.threshold.right);
  text +=
      "set               answers  right  AUC     ECE mass  ECE width  Brier   wrong accepted  "
      "right refused\n";
  for (const auto& [name, quality] : calibration.qualities) {
    const ThresholdCount& count = calibration.counts.at(name);
    text += fmt::format("{:17} {:7}  {:5}  {:.4f}  {:.4f}    {:.4f}     {:.4f}  {:14}  {:13}\n",
                        name, quality.answers, quality.right, quality.area_under_curve,
                        quality.error_equal_mass, quality.error_equal_width, quality.brier,
                        count.wrong_accepted, count.right_refused);
  }
  return text;
}

std::string calibrationJson(const Calibration& calibration) {
  nlohmann::ordered_json json;
  json["origin"] = calibration.origin;
  json["right"] = {{"rms_m", kRightRms}};
  json["intercept"] = calibration.model.intercept;
  for (std::size_t k = 0; k < verdict::kVerdictFeatures; ++k) {
    json["weights"][verdict::kVerdictFeatureNames[k]] =
        calibration.model.weights(static_cast<Eigen::Index>(k));
  }
  json["threshold"] = {{"probability", calibration.threshold.probability},
                       {"highest_wrong", calibration.threshold.highest_wrong},
                       {"right", calibration.threshold.right},
                       {"right_refused", calibration.threshold.refused},
                       {"refusal_rate", calibration.threshold.refusalRate()}};
  json["rows_without_answer"] = calibration.without_answer;
  json["solvable_without_answer"] = calibration.solvable_without;
  for (const auto& [name, quality] : calibration.qualities) {
    const ThresholdCount& count = calibration.counts.at(name);
    json["sets"][name] = {{"answers", quality.answers},
                          {"right", quality.right},
                          {"area_under_curve", quality.area_under_curve},
                          {"calibration_error_equal_mass", quality.error_equal_mass},
                          {"calibration_error_equal_width", quality.error_equal_width},
                          {"brier", quality.brier},
                          {"wrong_accepted", count.wrong_accepted},
                          {"right_refused", count.right_refused}};
  }
  return json.dump(2) + "\n";
}

std::string reliabilityCsv(const Calibration& calibration) {
  std::string text = "set,low,high,answers,right,mean_probability,right_low,right_high\n";
  for (const auto& [name, quality] : calibration.qualities) {
    for (const ReliabilityBin& bin : quality.bins) {
      text += fmt::format("{},{:.1f},{:.1f},{},{},{:.6f},{:.6f},{:.6f}\n", name, bin.low, bin.high,
                          bin.count, bin.right, bin.mean_probability, bin.interval.low,
                          bin.interval.high);
    }
  }
  return text;
}

}  // namespace agricolmap::campaign
