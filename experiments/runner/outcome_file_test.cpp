#include "experiments/runner/outcome_file.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::experiments {
namespace {

TEST(OutcomeFile, KeepsWhatAMethodFound) {
  Answer answer;
  answer.run_s = 1.5;
  answer.read_s = 0.25;
  answer.peak_mib = 300.0;
  MethodOutcome& outcome = answer.outcome;
  outcome.fixed_from_moving = Eigen::Translation3d(464000.25, 5257000.125, 500.0) *
                              Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
  outcome.ambiguous = true;
  outcome.why = "two places \xFF fit";  // not UTF-8
  outcome.times.add("level", 0.5);
  outcome.facts = {{"uniqueness", 1.25}, {"block_rms", std::nan("")}};
  outcome.stated.emplace();
  outcome.stated->pose.covariance.diagonal() << 1.0, 2.0, 3.0, 4.0, 5.0;
  outcome.stated->pose.centre = {7.0, 8.0};
  outcome.stated->pose.height_deviation = 0.02;
  outcome.stated->levelled_from_fixed = Eigen::Translation3d(1.0, 2.0, 3.0);
  const test::TempDir folder;
  folder.write("answer.json", toJson(answer, "default"));
  const Answer back = readAnswer(folder / "answer.json");
  EXPECT_EQ(back.run_s, 1.5);
  EXPECT_EQ(back.peak_mib, 300.0);
  EXPECT_EQ(statusOf(back.outcome), "ambiguous");
  ASSERT_TRUE(back.outcome.fixed_from_moving.has_value());
  EXPECT_EQ(back.outcome.fixed_from_moving->matrix(), outcome.fixed_from_moving->matrix());
  EXPECT_EQ(back.outcome.times.stages(), outcome.times.stages());
  EXPECT_EQ(factOf(back.outcome, "uniqueness"), 1.25);
  EXPECT_TRUE(std::isnan(factOf(back.outcome, "block_rms")));
  ASSERT_TRUE(back.outcome.stated.has_value());
  EXPECT_EQ(back.outcome.stated->pose.covariance, outcome.stated->pose.covariance);
  EXPECT_EQ(back.outcome.stated->pose.centre, outcome.stated->pose.centre);
  EXPECT_EQ(back.outcome.stated->levelled_from_fixed.translation().z(), 3.0);
}

TEST(OutcomeFile, NoAnswerIsNone) {
  const test::TempDir folder;
  Answer answer;
  answer.outcome.why = "no points";
  folder.write("answer.json", toJson(answer, "icp-affine"));
  const Answer back = readAnswer(folder / "answer.json");
  EXPECT_EQ(statusOf(back.outcome), "failed");
  EXPECT_EQ(back.outcome.why, "no points");
  EXPECT_FALSE(back.outcome.stated.has_value());
  folder.write("half.json", "{\"method\": ");
  test::expectError<InputError>([&] { readAnswer(folder / "half.json"); },
                                {"half.json", "no answer"});
  EXPECT_THROW(readAnswer(folder / "none.json"), InputError);
}

}  // namespace
}  // namespace agricolmap::experiments
