// The interface: names, failures, oracle scales; and the product's chains through it.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "agricolmap/core/error.hpp"
#include "experiments/methods/test_pair.hpp"

namespace agricolmap::experiments {
namespace {

TEST(Methods, NamesAreUniqueAndAllCanBeMade) {
  const std::vector<std::string> names = methodNames();
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  for (const std::string& name : names) {
    const std::unique_ptr<Method> method = makeMethod(name);
    EXPECT_EQ(method->name(), name);
    EXPECT_FALSE(method->about().empty());
  }
}

TEST(Methods, UnknownNamesListTheKnownOnes) {
  try {
    makeMethod("magic");
    FAIL() << "no exception";
  } catch (const UsageError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("magic"), std::string::npos);
    EXPECT_NE(what.find("agricolmap-rgb"), std::string::npos);
  }
}

TEST(Methods, OracleScaleWantsTheTruth) {
  const std::unique_ptr<Method> method = withOracleScale(makeMethod("default"));
  EXPECT_EQ(method->name(), "default-oracle-scale");
  EXPECT_THROW(method->run(testing::inputOf(testing::smallPair(), {}, {})), UsageError);
}

/// Hands back its guess.
class Echo : public Method {
 public:
  std::string name() const override { return "echo"; }
  std::string about() const override { return "its guess"; }

 protected:
  void attempt(const MethodInput& input, MethodOutcome& outcome) const override {
    EXPECT_FALSE(input.truth.has_value());
    outcome.fixed_from_moving = input.guess;
  }
};

TEST(Methods, OracleScaleMendsScalesAndNothingElse) {
  const simulate::SimulatedPair& pair = testing::smallPair();
  testing::GuessError error;
  error.shift = {0.7, -0.3};
  error.scale = {1.2, 0.8};
  MethodInput input = testing::inputOf(pair, error, {});
  input.truth = pair.best_affine;
  const MethodOutcome outcome = withOracleScale(std::make_unique<Echo>())->run(input);
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
  testing::expectRight(*makeMethod("default"), error, {});
  testing::expectFailsOnEmptyMaps(*makeMethod("default"));
}

TEST(Product, PaperChainFindsTheStripAndSaysItsMatches) {
  testing::GuessError error;
  error.shift = {0.6, -0.4};
  PriorUncertainty prior;
  prior.translation = 1.0;
  prior.heading_deg = 2.0;
  prior.scale = 0.05;
  const simulate::SimulatedPair& pair = testing::smallPair();
  const MethodOutcome outcome = makeMethod("agricolmap")->run(testing::inputOf(pair, error, prior));
  ASSERT_TRUE(outcome.fixed_from_moving.has_value()) << outcome.why;
  EXPECT_TRUE(testing::errorsOf(outcome, pair).within({}));
  ASSERT_TRUE(outcome.matches.has_value());
  ASSERT_TRUE(outcome.rematches.has_value());
  for (const MatchSet& set : {*outcome.matches, *outcome.rematches}) {
    ASSERT_GT(set.pairs.size(), 100U);
    EXPECT_LE(set.inliers, set.pairs.size());
    const auto right =
        std::count_if(set.pairs.begin(), set.pairs.end(), [&](const MatchedPair& match) {
          return (pair.best_affine * match.moving - match.fixed).head<2>().norm() < 0.1;
        });
    EXPECT_GT(static_cast<double>(right), 0.4 * static_cast<double>(set.pairs.size()));
  }
}

}  // namespace
}  // namespace agricolmap::experiments
