// What is planned, what is skipped, and that an interrupted campaign goes on.
#include "experiments/runner/campaign.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/test_support.hpp"

namespace agricolmap::experiments {
namespace {

/// A method that hands its guess back and counts how often it was asked.
struct Echo {
  int asked = 0;
  int interrupt_at = 0;
};
Method echoMethod(Echo& echo, std::string name, Traits traits = {}, std::string options = {}) {
  return {std::move(name), "its guess", traits,
          [&echo](const MethodInput& input, MethodOutcome& outcome) {
            if (++echo.asked == echo.interrupt_at) throw Interrupted();
            outcome.fixed_from_moving = input.guess;
            outcome.accepted = true;
            outcome.facts = {{"matches", 12.0}};
          },
          std::move(options)};
}

Case smallCase(const std::string& name) {
  Case one;
  one.name = name;
  one.dataset = "sugar-beet-20m";
  one.options = simulate::cropPreset(simulate::Crop::kSugarBeet20m);
  one.options.field.width = one.options.field.height = 6.0;
  one.options.ugv.length = 4.0;
  one.options.ugv.width = 1.2;
  one.options.geotag = {};
  one.options.geotag.translation = one.options.geotag.heading_deg = one.options.geotag.scale = 0.0;
  one.options.geotag.z = 0.0;
  one.strips_per_field = 2;
  return one;
}

class CampaignTest : public ::testing::Test {
 protected:
  CampaignTest() {
    suite_.name = "small";
    suite_.cases = {smallCase("a")};
    suite_.pairs = 2;
    suite_.first_seed = 8;
  }
  Echo& add(std::string name, Traits traits = {}, std::string options = {}) {
    Echo& echo = echoes_.emplace_back();
    methods_.push_back(echoMethod(echo, std::move(name), traits, std::move(options)));
    return echo;
  }
  CampaignScope scope() {
    CampaignScope scope;
    scope.suites = {suite_};
    scope.methods = std::exchange(methods_, {});
    scope.source = "abc1234";
    return scope;
  }
  /// The rows after a run.
  std::vector<Row> run(const CampaignScope& scope, double stop_after = 0.0) {
    PairMaker maker("/nowhere");
    RowTable table(folder_ / "rows.csv", scope.source);
    complete_ = runCampaign(scope, stop_after, maker, table);
    return table.rows();
  }

  test::TempDir folder_;
  Suite suite_;
  std::deque<Echo> echoes_;
  std::vector<Method> methods_;
  bool complete_ = false;
};

TEST_F(CampaignTest, OneRowForEachRun) {
  add("echo");
  const std::vector<Row> rows = run(scope());
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_TRUE(complete_);
  EXPECT_EQ(rows[1].seed, 9);
  EXPECT_EQ(rows[1].field, 8);
  EXPECT_EQ(rows[0].status, "accepted");
  EXPECT_EQ(rows[0].kind, "simulated");
  EXPECT_EQ(rows[0].matches, 12.0);
  EXPECT_GE(rows[0].threads, 1);
  EXPECT_TRUE(std::isfinite(rows[0].rms));
  EXPECT_TRUE(std::isnan(rows[0].uniqueness));
}

TEST_F(CampaignTest, GoesOnWhereItWasInterrupted) {
  Echo& echo = add("echo");
  echo.interrupt_at = 2;
  const CampaignScope both = scope();
  EXPECT_THROW(run(both), Interrupted);
  EXPECT_EQ(run(both).size(), 2U);
  EXPECT_EQ(echo.asked, 3) << "the first pair again";
  EXPECT_EQ(run(both).size(), 2U);
  EXPECT_EQ(echo.asked, 3) << "nothing is left";
}

TEST_F(CampaignTest, StopsBetweenPairs) {
  add("echo");
  EXPECT_EQ(run(scope(), 1e-9).size(), 0U);
  EXPECT_FALSE(complete_);
}

TEST_F(CampaignTest, MorePairsAndMethodsAddUp) {
  add("echo");
  run(scope());
  suite_.pairs = 3;
  add("echo");
  Echo& other = add("other");
  EXPECT_EQ(run(scope()).size(), 6U);
  EXPECT_EQ(other.asked, 3);
}

TEST_F(CampaignTest, RowsOfOtherOptionsAreRefused) {
  add("echo", {}, "cell 0.02");
  run(scope());
  add("echo", {}, "cell 0.03");
  test::expectError<InputError>([&] { run(scope()); },
                                {"small, a, seed 8, echo", "other options", "another --output"});
  add("echo", {}, "cell 0.02");
  suite_.cases[0].options.ugv.length = 3.5;
  EXPECT_THROW(run(scope()), InputError) << "another pair of the same name";
}

TEST_F(CampaignTest, MethodsThatNeedAGuessAreNotRunWithoutOne) {
  suite_.cases.push_back(smallCase("nowhere"));
  suite_.cases.back().told = PriorUncertainty::none();
  add("local");
  add("global", {.needs_guess = false});
  const std::vector<Row> rows = run(scope());
  EXPECT_EQ(rows.size(), 6U);
  for (const Row& row : rows) EXPECT_FALSE(row.method == "local" && row.case_name == "nowhere");
}

TEST_F(CampaignTest, MatchlessMethodsStayOut) {
  suite_.matching_only = true;
  suite_.pairs = 1;
  add("matching", {.matches_points = true});
  add("matchless");
  const std::vector<Row> rows = run(scope());
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].method, "matching");
}

TEST_F(CampaignTest, PairsOfOneViewFollowEachOther) {
  suite_.cases.push_back(smallCase("other view"));
  suite_.cases.back().options.field.gaps = 0.2;
  add("echo");
  CampaignScope both = scope();
  both.suites.push_back(both.suites.front());
  both.suites.back().name = "same pairs";
  const RowTable table(folder_ / "rows.csv", both.source);
  std::vector<std::string> order;
  for (const Job& job : planCampaign(both, table)) order.push_back(job.chosen->name);
  EXPECT_THAT(order, ::testing::ElementsAre("a", "a", "a", "a", "other view", "other view",
                                            "other view", "other view"));
}

TEST_F(CampaignTest, AddedErrorsAreThoseOfTheGuess) {
  suite_.curves = {{.scale = 0.1, .errors = {{0.5, 0.5, 0.0, 0.1}}}};
  suite_.pairs = 1;
  add("echo");
  const std::vector<Row> rows = run(scope());
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].setting, 0.5);
  EXPECT_EQ(rows[0].guess_scale, 0.1);
  EXPECT_NEAR(rows[0].e_t, 0.5, 0.02);
  EXPECT_NEAR(rows[0].e_s, 0.1 * std::sqrt(2.0), 0.02);
  EXPECT_FALSE(rows[0].right);
}

Row lostRow(const std::string& case_name, double setting, int seed, bool right = false) {
  Row row;
  row.suite = "small";
  row.case_name = case_name;
  row.kind = "simulated";
  row.setting = setting;
  row.seed = seed;
  row.method = "echo";
  row.accepted = row.right = right;
  return row;
}

TEST_F(CampaignTest, GivesUpOnlyAfterThreeLostSettingsAndSixLostRuns) {
  const std::vector<AddedError> errors = {
      {0.25, 0.25, 0.0, 0.0}, {0.5, 0.5, 0.0, 0.0}, {1.0, 1.0, 0.0, 0.0}, {2.0, 2.0, 0.0, 0.0}};
  Echo counts;
  const Method echo = echoMethod(counts, "echo");
  const Case other = smallCase("b");
  Chain chain{&suite_, &suite_.cases.front(), {}, true, &echo};
  for (const AddedError& error : errors) chain.errors.push_back(&error);
  Chain elsewhere = chain;
  elsewhere.chosen = &other;
  std::vector<Row> rows;
  for (const double setting : {0.25, 0.5, 1.0}) rows.push_back(lostRow("a", setting, 1));
  EXPECT_FALSE(hopeless(rows, chain, 3)) << "three runs are an anecdote";
  for (const double setting : {0.25, 0.5, 1.0}) rows.push_back(lostRow("a", setting, 2));
  EXPECT_TRUE(hopeless(rows, chain, 3));
  EXPECT_FALSE(hopeless(rows, elsewhere, 3)) << "never tried there";
  rows.push_back(lostRow("b", 1.0, 1, true));
  EXPECT_FALSE(hopeless(rows, chain, 3));
  chain.rising = false;
  rows.pop_back();
  EXPECT_FALSE(hopeless(rows, chain, 3)) << "no order, no conclusion";
}

TEST_F(CampaignTest, RigidMethodsAreNotTriedWhereTheScaleErrorAloneIsTooMuch) {
  const Traits rigid = {.rigid = true};
  EXPECT_FALSE(cannotBeRight(rigid, {1.0, 1.0, 0.0, 0.0}));
  EXPECT_TRUE(cannotBeRight(rigid, {0.05, 0.05, 0.01, 0.05}));
  EXPECT_FALSE(cannotBeRight({}, {0.05, 0.05, 0.01, 0.05}));
  suite_.curves = {{.scale = 0.1, .errors = {{0.5, 0.5, 0.0, 0.1}}}};
  Echo& echo = add("echo", rigid);
  const std::vector<Row> rows = run(scope());
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].status, "skipped");
  EXPECT_EQ(rows[0].message, "rigid");
  EXPECT_EQ(echo.asked, 0);
}

}  // namespace
}  // namespace agricolmap::experiments
