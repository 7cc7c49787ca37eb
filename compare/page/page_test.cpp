#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "page/comparison_page.hpp"
#include "page/paper_figures.hpp"
#include "page/statistics.hpp"
#include "page/summary.hpp"

namespace agricolmap::compare {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

Row makeRow(const std::string& method, const std::string& experiment, double setting, int seed,
            bool right) {
  Row row;
  row.dataset = "soybean";
  row.kind = "simulated";
  row.experiment = experiment;
  row.setting = setting;
  row.scale = experiment == "accuracy" ? setting : 0.0;
  row.seed = seed;
  row.method = method;
  row.status = "accepted";
  row.accepted = true;
  row.correct = right;
  row.errors.translation = 0.01;
  row.errors.rms = right ? 0.02 : 2.0;
  row.errors.rms_to_best_affine = method == "default" ? 0.004 : 0.009;
  row.run_s = method == "default" ? 1.0 : 2.0;
  row.peak_mib = 100.0;
  row.stages = "grid=0.25;search=0.75";
  return row;
}

/// `default` always right, `orb` right at 1 m only, `icp-affine` nowhere and given up at 5 m.
std::vector<Row> someRows() {
  std::vector<Row> rows;
  for (int seed = 1; seed <= 4; ++seed) {
    for (const double setting : {1.0, 5.0}) {
      rows.push_back(makeRow("default", "translation", setting, seed, true));
      rows.push_back(makeRow("orb", "translation", setting, seed, setting < 2.0));
      rows.push_back(makeRow("icp-affine", "translation", setting, seed, false));
      if (setting > 2.0) rows.back().status = "skipped";
      if (setting > 2.0) rows.back().accepted = false;
    }
    rows.push_back(makeRow("default", "accuracy", 0.05, seed, true));
    rows.push_back(makeRow("orb", "accuracy", 0.05, seed, true));
    rows.push_back(makeRow("orb", "inliers", 1.0, seed, true));
    rows.back().first = {200.0, 50.0, 100.0};
    rows.back().last = {100.0, 60.0, 90.0};
  }
  return rows;
}

TEST(HeldAnswers, GoIcpIsCountedByWhatItHeld) {
  Row held;
  held.method = "go-icp";
  held.status = "not_accepted";
  held.correct = true;
  Row refused = held;
  refused.method = "default";
  Row failed = held;
  failed.status = "failed";
  failed.correct = false;
  const std::vector<Row> rows = withHeldAnswers({held, refused, failed});
  EXPECT_TRUE(rows[0].success());
  EXPECT_FALSE(rows[1].success()) << "who can say no is taken at its word";
  EXPECT_FALSE(rows[2].accepted);
}

TEST(ComparePage, CountsSkippedRunsAsFailuresAndWrongAnswersApart) {
  const std::vector<Row> rows = someRows();
  const Group given_up = groupOf(
      rows, [](const Row& row) { return row.method == "icp-affine" && row.setting == 5.0; });
  EXPECT_EQ(given_up.runs, 4U);
  EXPECT_EQ(given_up.skipped, 4U);
  EXPECT_EQ(given_up.share(), 0.0);
  const Group wrong =
      groupOf(rows, [](const Row& row) { return row.method == "orb" && row.setting == 5.0; });
  EXPECT_EQ(wrong.wrong, 4U);
}

TEST(ComparePage, SaysWhereTheDefaultIsAheadAndWhereItIsNot) {
  std::vector<Row> rows = someRows();
  EXPECT_THAT(summarySentences(rows),
              HasSubstr("At 1 of 3 settings the default preset succeeds more often than every "
                        "other method, at 2 as often as the best of them. Beside the methods of "
                        "others alone it is ahead at 1 of 3. There is no setting"));
  for (Row& row : rows) {
    if (row.method == "default" && row.setting == 1.0) row.correct = false;
    if (row.method == "default") row.errors.rms_to_best_affine = 0.012;
  }
  const std::string behind = summarySentences(rows);
  EXPECT_THAT(behind, HasSubstr("1 m with 0 % scale, simulated (0 against 1 of orb)"));
  EXPECT_THAT(behind, HasSubstr("soybean at 5 % (12.0 mm against 9.0 mm of orb)"));
}

TEST(ComparePage, MethodsAreComparedOnThePairsOfBoth) {
  std::vector<Row> rows = someRows();
  // Hard pairs that only the default preset was run on: neither its rate nor its error suffers.
  for (int seed = 5; seed <= 14; ++seed) {
    rows.push_back(makeRow("default", "translation", 1.0, seed, false));
    rows.push_back(makeRow("default", "accuracy", 0.05, seed, true));
    rows.back().errors.rms_to_best_affine = 0.03;
  }
  const std::string text = summarySentences(rows);
  EXPECT_THAT(text, HasSubstr("There is no setting"));
  EXPECT_THAT(text, HasSubstr("the smallest in 1."));
  EXPECT_THAT(text, HasSubstr("right and says so in 22 of 32 runs on 14 pairs"));
  EXPECT_THAT(text, HasSubstr("default 10 of 32, icp-affine 4 of 4, orb 4 of 12"));
}

TEST(ComparePage, TablesHaveThePapersFigures) {
  EXPECT_EQ(paperAccuracy("soybean", "agricolmap", 1), "0.03 m / 0.04° / 1.9 %");
  EXPECT_EQ(paperAccuracy("winter-wheat", "cpd-affine", 6), "fail");
  EXPECT_EQ(paperAccuracy("semireal-sugarbeet", "orb", 0), "0.02 m / 0.03° / –");
  EXPECT_EQ(paperAccuracy("soybean", "default", 0), "");
  EXPECT_EQ(paperInliers("sugar-beet-20m", "agricolmap"), "68.1 ± 13.6");
  EXPECT_EQ(paperTimes("go-icp"), "5.3 / 689.2 / 193.1");
  const std::vector<Row> rows = someRows();
  EXPECT_THAT(accuracyCsv(rows), HasSubstr("0.04 m / 0.04° / 2.2 %"));
  EXPECT_THAT(successCsv(rows, "translation"),
              HasSubstr("simulated,soybean,0,5,orb,4,0,0.0000,0.0000,0.4899,0,4,0,0,0.82–0.88"));
  EXPECT_THAT(
      inliersCsv(rows),
      HasSubstr("simulated,soybean,orb,4,200,25.00,0.00,50.00,0.00,100,60.00,0.00,90.00,0.00,"));
  EXPECT_THAT(timesCsv(rows), HasSubstr("search=0.750;grid=0.250,3.9 / 6.7 / 4.8"));
}

TEST(ComparePage, RealPairsAreAKindOfTheirOwn) {
  EXPECT_EQ(paperAccuracy("2018/Sugar Beet_20 m/ugv_row10", "surf", 0), "0.03 m / 0.04° / –");
  EXPECT_EQ(paperAccuracy("Soybean/row soy wheat", "agricolmap", 1), "0.03 m / 0.04° / 1.9 %");
  EXPECT_EQ(paperAccuracy("barley/wheat row", "agricolmap", 1), "") << "the crop's folder counts";
  EXPECT_EQ(paperInliers("beet/ugv", "agricolmap"), "68.1 ± 13.6");
  EXPECT_EQ(paperInliers("barley/ugv", "agricolmap"), "");

  std::vector<Row> rows = someRows();
  EXPECT_THAT(toHtml(comparisonDocument(rows, "")), Not(HasSubstr("Real data sets")));
  for (Row row : someRows()) {
    row.dataset = "winter_wheat/ugv_row1";
    row.kind = "real";
    rows.insert(rows.begin(), row);
    row.dataset = "real-soybean";
    row.kind = "semi-real";
    rows.insert(rows.begin(), row);
  }
  EXPECT_THAT(kindsOf(rows), ElementsAre("simulated", "semi-real", "real"));
  EXPECT_THAT(dataSetsOf(rows), ElementsAre("soybean", "real-soybean", "winter_wheat/ugv_row1"));
  EXPECT_THAT(successCsv(rows, "translation"), HasSubstr("real,winter_wheat/ugv_row1,0,5,orb,4,0"));
  EXPECT_THAT(summarySentences(rows), HasSubstr("At 3 of 9 settings"));
  const std::string page = toHtml(comparisonDocument(rows, ""));
  for (const char* kind : {"simulated", "semi-real", "real"}) {
    EXPECT_THAT(page, HasSubstr(fmt::format("Translation error at scale error 0 %, {}", kind)));
    EXPECT_THAT(page, HasSubstr(fmt::format("Success over translation error, {}: ", kind)));
  }
  EXPECT_THAT(page, HasSubstr("winter_wheat/ugv_row1 (real)"));
  EXPECT_THAT(page, HasSubstr("Real data sets are one pair of real clouds each"));
}

TEST(ComparePage, IsOneFileThatNeedsNothingElse) {
  const std::vector<Row> rows = someRows();
  const std::string page = toHtml(comparisonDocument(rows, "version <1>"));
  EXPECT_THAT(page, HasSubstr("version &lt;1&gt;"));
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("paper, real data: 3.9 / 6.7 / 4.8"));
  for (const char* outside : {"<script", "src=", "href=", "@import", "url("}) {
    EXPECT_EQ(page.find(outside), std::string::npos) << outside;
  }
  const std::string markdown = toMarkdown(comparisonDocument(rows, "version 1"), "images");
  EXPECT_THAT(markdown, HasSubstr("(images/success_translation_simulated_points.svg)"));
}

}  // namespace
}  // namespace agricolmap::compare
