#include "agricolmap/refine/multi_start.hpp"

#include <gtest/gtest.h>

#include <array>

#include "agricolmap/map/test_scene.hpp"
#include "agricolmap/refine/fit.hpp"

namespace agricolmap::refine {
namespace {

using testing::shifted;
using testing::TestScene;

constexpr double kExclusion = 0.35;

class MultiStartTest : public ::testing::Test {
 protected:
  const TestScene scene_ = testing::testScene({.size = 12.0}, {{0.5, -0.3}, 0.04, 1.04, 0.97});
  const correlation::MapSignals fixed_{scene_.fixed, {}};
  const correlation::MapSignals moving_{scene_.moving, {}};
  const PairSignals signals_{fixed_, moving_, {}, {}};
  const Eigen::Affine2d& truth_ = scene_.pose;
};

TEST_F(MultiStartTest, StartsOfOnePlaceAreOneAndTheBestIsFirst) {
  const std::array<Eigen::Affine2d, 4> starts = {
      shifted(truth_, {1.4, 0.9}),     // another place
      shifted(truth_, {200.0, 0.0}),   // off the map
      shifted(truth_, {0.06, -0.04}),  // two of the right one
      shifted(truth_, {-0.05, 0.05})};
  const RankedPoses ranked = refineStarts(signals_, starts, kExclusion, {});
  ASSERT_FALSE(ranked.distinct.empty());
  EXPECT_GE(ranked.held, 2U);
  EXPECT_LT(ranked.held, starts.size());
  EXPECT_LT(ranked.distinct.size(), ranked.held + 1);
  const RefinedPose& best = ranked.distinct.front();
  EXPECT_GE(best.start, 2U);
  EXPECT_LT(signals_.score().distance(best.pose, truth_), 0.03);
  for (std::size_t i = 1; i < ranked.distinct.size(); ++i) {
    EXPECT_LE(ranked.distinct[i].significance, best.significance);
    EXPECT_GT(signals_.score().distance(ranked.distinct[i].pose, best.pose), kExclusion);
  }
}

TEST_F(MultiStartTest, FinerCellsBringItNearer) {
  const std::array<Eigen::Affine2d, 1> starts = {shifted(truth_, {0.07, 0.03})};
  const RankedPoses ranked = refineStarts(signals_, starts, kExclusion, {});
  ASSERT_EQ(ranked.distinct.size(), 1U);
  const RefinedPose fine = refineFinely(signals_, ranked.distinct.front(), {});
  EXPECT_LT(signals_.score().distance(fine.pose, truth_), 0.008);
  EXPECT_EQ(fine.start, 0U);
  const auto from = refineFrom(signals_, shifted(truth_, {0.05, -0.02}), {});
  ASSERT_TRUE(from);
  EXPECT_LT(signals_.score().distance(from->pose, truth_), 0.008);
  EXPECT_FALSE(refineFrom(signals_, shifted(truth_, {200.0, 0.0}), {}));
}

TEST_F(MultiStartTest, FitIsHighestAtTheTruth) {
  const SignalPair whole = signals_.whole(kRankingFactor);
  const Fit right = fitOf(whole.fixed, whole.moving, truth_);
  EXPECT_GT(right.overlap, 0.97);
  EXPECT_GT(right.correlation, 0.6);
  EXPECT_LT(fitOf(whole.fixed, whole.moving, shifted(truth_, {0.3, 0.2})).correlation,
            0.5 * right.correlation);
  const Fit half = fitOf(whole.fixed, whole.moving, shifted(truth_, {5.5, 0.0}));
  EXPECT_NEAR(half.overlap, 0.5, 0.12);
  EXPECT_EQ(fitOf(whole.fixed, whole.moving, shifted(truth_, {100.0, 0.0})).overlap, 0.0);
}

}  // namespace
}  // namespace agricolmap::refine
