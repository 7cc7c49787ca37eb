#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "agricolmap/core/error.hpp"
#include "campaign_summary.hpp"
#include "campaign_table.hpp"

namespace agricolmap::campaign {
namespace {

class TemporaryTable : public testing::Test {
 protected:
  TemporaryTable()
      : path_(std::filesystem::temp_directory_path() /
              ("campaign_test_" + std::to_string(::getpid()) + ".csv")) {}
  ~TemporaryTable() override { std::filesystem::remove(path_); }
  const std::filesystem::path path_;
};

PairRow row(const std::string& name, int seed, bool accepted, bool correct, double rms) {
  PairRow made;
  made.case_name = name;
  made.seed = seed;
  made.preset = "default";
  made.accepted = accepted;
  made.correct = correct;
  made.errors = noErrors();
  made.errors.rms_to_best_affine = rms;
  made.errors.rms = 2.0 * rms;
  made.total_s = 1.0 + seed;
  return made;
}

TEST(WilsonInterval, MatchesKnownValues) {
  // R: prop.test(x, n, correct = FALSE)$conf.int
  EXPECT_NEAR(wilsonInterval(9, 10).low, 0.5958500, 1e-6);
  EXPECT_NEAR(wilsonInterval(9, 10).high, 0.9821238, 1e-6);
  EXPECT_NEAR(wilsonInterval(60, 60).low, 0.9398282, 1e-6);
  EXPECT_NEAR(wilsonInterval(60, 60).high, 1.0, 1e-12);
  EXPECT_NEAR(wilsonInterval(0, 60).low, 0.0, 1e-12);
  EXPECT_NEAR(wilsonInterval(0, 60).high, 0.0601718, 1e-6);
  EXPECT_EQ(wilsonInterval(0, 0).low, 0.0);
  EXPECT_EQ(wilsonInterval(0, 0).high, 1.0);
}

TEST(Quantile, Interpolates) {
  EXPECT_DOUBLE_EQ(quantile({3.0, 1.0, 2.0}, 0.5), 2.0);
  EXPECT_DOUBLE_EQ(quantile({0.0, 10.0}, 0.95), 9.5);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST_F(TemporaryTable, RowsSurviveReopening) {
  {
    PairTable table(path_, "origin");
    PairRow first = row("soybean-easy", 7, true, true, 0.0061234567);
    first.stages = "level=0.1;grid=0.2";
    first.note = "a, b\nc";
    first.field = 6;
    first.status = "accepted";
    first.blocks = 16.0;
    first.probability = 0.97;
    table.append(first);
    EXPECT_TRUE(table.has("soybean-easy", 7, "default"));
  }
  const PairTable table(path_, "origin");
  ASSERT_EQ(table.rows().size(), 1U);
  EXPECT_TRUE(table.has("soybean-easy", 7, "default"));
  EXPECT_FALSE(table.has("soybean-easy", 8, "default"));
  EXPECT_FALSE(table.has("soybean-easy", 7, "paper"));
  const PairRow& read = table.rows().front();
  EXPECT_TRUE(read.success());
  EXPECT_DOUBLE_EQ(read.errors.rms_to_best_affine, 0.0061234567);
  EXPECT_TRUE(std::isnan(read.errors.scale));
  EXPECT_EQ(read.stages, "level=0.1;grid=0.2");
  EXPECT_EQ(read.note, "a  b c");
  EXPECT_EQ(read.field, 6);
  EXPECT_EQ(read.status, "accepted");
  EXPECT_DOUBLE_EQ(read.blocks, 16.0);
  EXPECT_DOUBLE_EQ(read.probability, 0.97);
  EXPECT_TRUE(std::isnan(read.expected_rms));
}

TEST_F(TemporaryTable, RemovesALineCutOffByACrash) {
  {
    PairTable table(path_, "origin");
    table.append(row("a", 1, true, true, 0.01));
  }
  std::ofstream(path_, std::ios::app) << "a,2,default,0,1";
  {
    PairTable table(path_, "origin");
    EXPECT_EQ(table.rows().size(), 1U);
    EXPECT_FALSE(table.has("a", 2, "default"));
    table.append(row("a", 2, true, true, 0.01));
  }
  std::string identity;
  EXPECT_EQ(readPairs(path_, identity).size(), 2U);
  EXPECT_EQ(identity, "origin");
}

TEST_F(TemporaryTable, RefusesRowsOfOtherOriginOrShape) {
  { const PairTable table(path_, "origin"); }
  EXPECT_THROW(PairTable(path_, "other origin"), InputError);
  std::ofstream(path_, std::ios::app) << "too,few\n";
  EXPECT_THROW(PairTable(path_, "origin"), InputError);
  std::ofstream(path_) << "case,seed\n";
  EXPECT_THROW(PairTable(path_, "origin"), InputError);
}

TEST_F(TemporaryTable, RefusesASecondWriter) {
  const PairTable table(path_, "origin");
  EXPECT_THROW(PairTable(path_, "origin"), OutputError);
}

TEST(Summary, CountsAndJudges) {
  std::vector<PairRow> rows = {row("b", 1, true, true, 0.004), row("b", 2, true, true, 0.006),
                               row("b", 3, true, false, 0.9), row("b", 4, false, true, 0.005),
                               row("a", 1, true, true, 0.03)};
  rows.push_back(row("none", 1, true, false, 5.0));
  rows.back().negative = true;
  const auto lines =
      summarise(rows, {"b", "a", "none"},
                {{"b", {.min_success = 0.5, .max_accepted = {}, .max_rms = 0.01}},
                 {"none", {.min_success = {}, .max_accepted = 0.02, .max_rms = {}}}});
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].case_name, "b");
  EXPECT_EQ(lines[0].pairs, 4U);
  EXPECT_EQ(lines[0].successes, 2U);
  EXPECT_EQ(lines[0].accepted, 3U);
  EXPECT_EQ(lines[0].false_accepts, 1U);
  EXPECT_DOUBLE_EQ(lines[0].rms_median, 0.005);
  EXPECT_DOUBLE_EQ(lines[0].rms3d_median, 0.010);
  EXPECT_DOUBLE_EQ(lines[0].time_median, 3.5);
  EXPECT_EQ(lines[0].met(), true);
  EXPECT_EQ(lines[1].met(), std::nullopt);
  EXPECT_EQ(lines[2].met(), false);
  const std::string markdown = summaryMarkdown(lines, "origin");
  EXPECT_NE(markdown.find("| b | default | 4 | 50.0 ("), std::string::npos) << markdown;
  EXPECT_NE(markdown.find("accepted ≤ 2 % | **no** |"), std::string::npos) << markdown;
  EXPECT_NE(summaryCsv(lines).find("b,default,4,0.5000,"), std::string::npos);
}

TEST(Summary, NoSuccessMeetsNoLimitOfError) {
  const auto lines = summarise({row("a", 1, false, false, 0.001)}, {"a"},
                               {{"a", {.min_success = {}, .max_accepted = {}, .max_rms = 0.01}}});
  EXPECT_EQ(lines.front().met(), false);
}

}  // namespace
}  // namespace agricolmap::campaign
