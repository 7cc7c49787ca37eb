#include "calibration.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/verdict/probability.hpp"

namespace agricolmap::campaign {
namespace {

/// Samples of a known model: features of several sizes, outcomes drawn from the probability.
struct Drawn {
  Eigen::MatrixXd features;
  Eigen::VectorXd right;
  LogisticModel model;
};

Drawn draw(int count) {
  Drawn drawn;
  drawn.model.intercept = -0.7;
  drawn.model.weights = Eigen::Vector3d(1.5, -2.0, 0.02);
  drawn.features.resize(count, 3);
  drawn.right.resize(count);
  Random random(5);
  for (int i = 0; i < count; ++i) {
    drawn.features.row(i) << random.normal(), 0.5 + random.normal(0.7), 40.0 + random.normal(30.0);
    const double p = drawn.model.probability(drawn.features.row(i).transpose());
    drawn.right(i) = random.chance(p) ? 1.0 : 0.0;
  }
  return drawn;
}

TEST(Logistic, RecoversTheModelThatDrewTheData) {
  const Drawn drawn = draw(20000);
  const LogisticModel model = fitLogistic(drawn.features, drawn.right, 1e-3);
  EXPECT_NEAR(model.intercept, drawn.model.intercept, 0.1);
  EXPECT_NEAR(model.weights(0), 1.5, 0.08);
  EXPECT_NEAR(model.weights(1), -2.0, 0.1);
  EXPECT_NEAR(model.weights(2), 0.02, 0.002);
}

TEST(Logistic, AWeightOfTheWrongSignIsLeftOut) {
  const Drawn drawn = draw(20000);
  const Eigen::Vector3d signs(1.0, 1.0, 1.0);  // the second feature's true weight is negative
  const LogisticModel model = fitLogistic(drawn.features, drawn.right, 1e-3, signs);
  EXPECT_GT(model.weights(0), 0.5);
  EXPECT_EQ(model.weights(1), 0.0);
  EXPECT_GT(model.weights(2), 0.005);
}

TEST(Logistic, StaysFiniteWhenTheKindsSeparate) {
  Eigen::MatrixXd x(6, 1);
  x << -3.0, -2.0, -1.0, 1.0, 2.0, 3.0;
  Eigen::VectorXd y(6);
  y << 0, 0, 0, 1, 1, 1;
  const LogisticModel model = fitLogistic(x, y, 0.1);
  EXPECT_GT(model.weights(0), 0.5);
  EXPECT_LT(model.weights(0), 20.0);
  EXPECT_THROW(fitLogistic(x, Eigen::VectorXd::Ones(6), 0.1), InputError);
}

TEST(Quality, CalibratedStatementsHaveSmallErrorAndOthersDoNot) {
  Random random(9);
  std::vector<Statement> calibrated;
  std::vector<Statement> bold;
  for (int i = 0; i < 20000; ++i) {
    const double p = random.uniform();
    const bool right = random.chance(p);
    calibrated.push_back({p, right});
    bold.push_back({p < 0.5 ? 0.02 : 0.98, right});
  }
  for (const bool equal_mass : {true, false}) {
    EXPECT_LT(calibrationError(calibrated, equal_mass), 0.015);
    EXPECT_NEAR(calibrationError(bold, equal_mass), 0.23, 0.03);
  }
  // For P uniform: the area is 5/6, the Brier score 1/6.
  EXPECT_NEAR(areaUnderCurve(calibrated), 5.0 / 6.0, 0.01);
  EXPECT_NEAR(brierScore(calibrated), 1.0 / 6.0, 0.01);
  EXPECT_EQ(reliability(calibrated).size(), 10U);
  EXPECT_DOUBLE_EQ(areaUnderCurve({{0.2, false}, {0.2, true}}), 0.5);
  EXPECT_DOUBLE_EQ(areaUnderCurve({{0.2, false}, {0.3, true}}), 1.0);
}

TEST(Quality, ThresholdAcceptsNothingWrong) {
  const std::vector<Statement> statements = {{0.10, false}, {0.80, false}, {0.70, true},
                                             {0.82, true},  {0.95, true},  {0.99, true}};
  const AcceptThreshold chosen = chooseThreshold(statements, 0.5);
  EXPECT_DOUBLE_EQ(chosen.highest_wrong, 0.80);
  EXPECT_NEAR(chosen.probability, 0.8683, 1e-3);
  EXPECT_EQ(chosen.right, 4U);
  EXPECT_EQ(chosen.refused, 2U);
  const ThresholdCount count = countAt(statements, chosen.probability);
  EXPECT_EQ(count.wrong_accepted, 0U);
  EXPECT_EQ(count.right_refused, 2U);
}

PairRow answer(int field, bool right, double uniqueness) {
  PairRow row;
  row.case_name = std::string("case");
  row.preset = "default";
  row.field = field;
  row.errors = noErrors();
  row.errors.rms = right ? 0.01 : 2.0;
  row.uniqueness = uniqueness;
  row.significance = 10.0;
  row.blocks = 16.0;
  row.agreement = right ? 0.9 : 0.1;
  row.block_rms = 0.03;
  row.overlap = 1.0;
  return row;
}

TEST(Calibration, SplitsByFieldAndLeavesOutRowsWithoutAnswer) {
  Random random(3);
  std::vector<PairRow> rows;
  for (int i = 0; i < 300; ++i) {
    const bool right = random.chance(0.6);
    rows.push_back(answer(6 * (i / 6), right, std::exp(random.normal(0.3) + (right ? 1.2 : 0.1))));
  }
  rows.push_back(answer(0, true, 3.0));
  rows.back().errors = noErrors();
  rows.push_back(answer(0, true, 3.0));
  rows.back().preset = "paper";
  rows.push_back(answer(0, true, 3.0));
  rows.back().negative = true;  // near where it would have lain, and wrong all the same
  const CalibrationSamples samples = samplesOf(rows, "default");
  EXPECT_EQ(samples.features.rows(), 301);
  EXPECT_EQ(samples.without_answer, 1U);
  EXPECT_EQ(samples.solvable_without, 1U);
  EXPECT_EQ(samples.right(300), 0.0);

  Calibration made;
  made.model = fitLogistic(samples.features, samples.right, 1.0);
  const std::vector<Statement> unseen = crossValidate(samples, 5, 1.0);
  ASSERT_EQ(unseen.size(), 301U);
  EXPECT_GT(areaUnderCurve(unseen), 0.97);
  made.threshold = chooseThreshold(unseen, 0.5);
  made.qualities["cross-validation"] = qualityOf(unseen);
  made.counts["cross-validation"] = countAt(unseen, made.threshold.probability);
  EXPECT_NE(calibrationJson(made).find("\"log_uniqueness\""), std::string::npos);
  EXPECT_NE(reliabilityCsv(made).find("cross-validation,0.0,0.1,"), std::string::npos);
  EXPECT_NE(calibrationText(made).find("accept from"), std::string::npos);
}

}  // namespace
}  // namespace agricolmap::campaign
