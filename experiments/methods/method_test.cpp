// The interface: names, failures, oracle scales; and the product's chains through it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "agricolmap/core/error.hpp"
#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

/// The fact of that name; NaN if the method told none.
double factOf(const MethodOutcome& outcome, const std::string& name) {
  for (const auto& [known, value] : outcome.facts) {
    if (known == name) return value;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

TEST(Methods, NamesAreUniqueAndAllCanBeMade) {
  const std::vector<std::string> names = methodNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) {
    const Method method = makeMethod(name);
    EXPECT_EQ(method.name, name);
    EXPECT_FALSE(method.about.empty());
  }
}

TEST(Methods, UnknownNamesListTheKnownOnes) {
  try {
    makeMethod("magic");
    FAIL() << "no exception";
  } catch (const UsageError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("magic"), std::string::npos);
    EXPECT_NE(what.find("paper-literal"), std::string::npos);
  }
}

TEST(Methods, OracleScaleWantsTheTruth) {
  const Method method = withOracleScale(makeMethod("default"));
  EXPECT_EQ(method.name, "default-oracle-scale");
  EXPECT_THROW(method.run(testing::inputOf(testing::smallPair(), {}, {})), UsageError);
}

TEST(Methods, OracleScaleMendsScalesAndNothingElse) {
  const simulate::SimulatedPair& pair = testing::smallPair();
  testing::GuessError error;
  error.shift = {0.7, -0.3};
  error.scale = {1.2, 0.8};
  MethodInput input = testing::inputOf(pair, error, {});
  input.truth = pair.best_affine;
  const Method echo = {"echo", "its guess", {}, [](const MethodInput& given, MethodOutcome& found) {
                         EXPECT_FALSE(given.truth.has_value());
                         found.fixed_from_moving = given.guess;
                       }};
  const MethodOutcome outcome = withOracleScale(echo).run(input);
  ASSERT_TRUE(outcome.fixed_from_moving.has_value());
  const Eigen::Affine3d expected = Eigen::Translation3d(0.7, -0.3, 0.0) * pair.best_affine;
  for (const std::size_t i : {std::size_t{0}, pair.ugv.size() / 2, pair.ugv.size() - 1}) {
    const Eigen::Vector3d point = pair.ugv.filePoint(i);
    EXPECT_LT((*outcome.fixed_from_moving * point - expected * point).norm(), 1e-3);
  }
}

TEST(Product, DefaultFindsTheStrip) {
  testing::GuessError error;
  error.shift = {1.5, -0.8};
  error.heading = 0.05;
  error.scale = {1.05, 0.96};
  testing::expectRight(makeMethod("default"), error, {});
  testing::expectFailsOnEmptyMaps(makeMethod("default"));
}

TEST(Product, PaperChainFindsTheStripAndSaysItsMatches) {
  testing::GuessError error;
  error.shift = {0.6, -0.4};
  PriorUncertainty prior;
  prior.translation = 1.0;
  prior.heading_deg = 2.0;
  prior.scale = 0.05;
  const simulate::SimulatedPair& pair = testing::smallPair();
  MethodInput input = testing::inputOf(pair, error, prior);
  input.truth = pair.best_affine;
  input.right_match = 0.1;
  const MethodOutcome outcome = makeMethod("paper").run(input);
  ASSERT_TRUE(outcome.fixed_from_moving.has_value()) << outcome.why;
  EXPECT_TRUE(testing::errorsOf(outcome, pair).within({}));
  for (const std::string matching : {"matches", "rematches"}) {
    const double all = factOf(outcome, matching);
    ASSERT_GT(all, 100.0) << matching;
    EXPECT_LE(factOf(outcome, matching + "_coherent"), all);
    EXPECT_GT(factOf(outcome, matching + "_right"), 0.4 * all);
  }
}

TEST(Product, TellsWhatItsProbabilityRestsOn) {
  const MethodOutcome outcome =
      makeMethod("default").run(testing::inputOf(testing::smallPair(), {}, {}));
  ASSERT_TRUE(outcome.accepted) << outcome.why;
  for (const char* name :
       {"plane_probability", "heights_limited", "uniqueness", "significance", "agreeing", "blocks",
        "expected_rms", "local_rms", "height_deviation", "overlap", "attempts"}) {
    EXPECT_TRUE(std::isfinite(factOf(outcome, name))) << name;
  }
  EXPECT_TRUE(outcome.stated.has_value());
  EXPECT_TRUE(std::isnan(factOf(outcome, "matches"))) << "it matches no points";
}

TEST(Product, TakesOptionsAfterItsPreset) {
  const Method changed = makeMethod("default:grid.cell=0.03:refine=cpd");
  EXPECT_EQ(changed.name, "default:grid.cell=0.03:refine=cpd");
  EXPECT_NE(changed.options, makeMethod("default").options);
  for (const char* wrong : {"default:grid.sell=0.03", "default:grid.cell",
                            "default:", "default:grid.cell=wide", "default:grid.cell=-1"}) {
    EXPECT_THROW(makeMethod(wrong), UsageError) << wrong;
  }
  EXPECT_THROW(makeMethod("defaults:grid.cell=0.03"), UsageError);
}

TEST(Traits, SayWhatEachMethodIs) {
  EXPECT_FALSE(makeMethod("default").traits.needs_guess);
  EXPECT_FALSE(makeMethod("default").traits.matches_points);
  EXPECT_TRUE(makeMethod("paper").traits.needs_guess);
  EXPECT_TRUE(makeMethod("paper").traits.matches_points);
  EXPECT_TRUE(makeMethod("default:association=flow").traits.needs_guess);
  EXPECT_FALSE(makeMethod("icp-affine").traits.rigid);
  const Method rigid = {"rigid", "no scale", {.rigid = true}, {}};
  EXPECT_FALSE(withOracleScale(rigid).traits.rigid);
}

}  // namespace
}  // namespace agricolmap::experiments
