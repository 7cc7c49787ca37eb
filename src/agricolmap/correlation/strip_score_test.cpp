#include "agricolmap/correlation/strip_score.hpp"

#include <gtest/gtest.h>

#include "agricolmap/correlation/map_signals.hpp"
#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::correlation {
namespace {

using testing::shifted;
using testing::TestScene;

constexpr int kFactor = 3;

class StripScoreTest : public ::testing::Test {
 protected:
  const TestScene scene_ = testing::testScene({.size = 12.0}, {{0.6, -0.4}, 0.05, 1.06, 0.95});
  const MapSignals fixed_{scene_.fixed, {}};
  const MapSignals moving_{scene_.moving, {}};
  const StripScore score_{fixed_.at(kFactor), moving_.at(kFactor), fixed_.filter(kFactor, {})};
};

TEST_F(StripScoreTest, TheTruePlaceStandsOutOfAllShifts) {
  const ScorePeaks peaks = score_.peaks(scene_.pose, scene_.middle, 3.0, 0.35);
  EXPECT_GT(peaks.significance, 8.0);
  EXPECT_GT(peaks.significance, 2.0 * peaks.other);
  EXPECT_GT(peaks.other, 1.0);
}

TEST_F(StripScoreTest, AWrongPlaceScoresAsChanceDoes) {
  for (const Eigen::Vector2d& shift :
       {Eigen::Vector2d(0.7, 0.3), {-0.5, 0.45}, {0.0, -0.9}, {1.3, 0.0}}) {
    EXPECT_LT(score_.significance(shifted(scene_.pose, shift)),
              0.5 * score_.significance(scene_.pose))
        << shift.transpose();
  }
}

TEST_F(StripScoreTest, APeakBesideAWrongPlaceIsFoundAndWithinTheExclusionIsNot) {
  const Eigen::Affine2d wrong = shifted(scene_.pose, {0.9, 0.0});
  const double right = score_.significance(scene_.pose);
  EXPECT_NEAR(score_.peaks(wrong, scene_.middle, 3.0, 0.35).other, right, 0.25 * right);
  EXPECT_LT(score_.peaks(wrong, scene_.middle, 3.0, 1.2).other, 0.6 * right);
}

TEST_F(StripScoreTest, OnlyShiftsThatTheGuessAllowsCount) {
  // The true place is 0.72 m from the guess.
  const Eigen::Affine2d wrong = shifted(scene_.pose, {-1.5, 1.0});
  EXPECT_LT(score_.peaks(wrong, scene_.middle, 0.4, 0.35).other,
            0.6 * score_.peaks(wrong, scene_.middle, 3.0, 0.35).other);
}

TEST_F(StripScoreTest, NothingWhereThereIsNoMap) {
  EXPECT_EQ(score_.significance(shifted(scene_.pose, {100.0, 0.0})), 0.0);
}

TEST_F(StripScoreTest, DistancesAreOfTheFarthestCorner) {
  EXPECT_NEAR(score_.distance(scene_.pose, shifted(scene_.pose, {0.3, -0.4})), 0.5, 1e-12);
}

TEST(MapSignals, MakesEachMapOnce) {
  const TestScene scene = testing::testScene({.size = 6.0}, {}, 3.0, 1.2);
  const MapSignals signals(scene.fixed, {});
  EXPECT_EQ(&signals.at(3), &signals.at(3));
  EXPECT_NE(&signals.at(3), &signals.at(6));
  EXPECT_EQ(&signals.filter(6, {}), &signals.filter(6, {}));
  EXPECT_NE(&signals.filter(6, {}), &signals.filter(6, {}, 4));
  EXPECT_NE(&signals.filter(6, {}), &signals.filter(6, {.floor = 1.0}));
  const map::SignalMap alone = map::makeSignalMap(scene.fixed, 3, {});
  EXPECT_EQ(alone.deviation[0], signals.at(3).deviation[0]);
}

/// The map in the middle of a frame that is `rim` cells larger on each side, empty there.
map::GridMap padded(const map::GridMap& map, int rim) {
  map::GridMap large = map;
  large.frame.rows += 2 * rim;
  large.frame.cols += 2 * rim;
  large.frame.corner -= Eigen::Vector2d::Constant(rim * map.frame.cell);
  const auto widened = [&](auto raster) {
    decltype(raster) wide(large.frame.rows, large.frame.cols);
    for (int r = 0; r < map.frame.rows; ++r) {
      for (int c = 0; c < map.frame.cols; ++c) wide(r + rim, c + rim) = raster(r, c);
    }
    return wide;
  };
  large.weight = widened(map.weight);
  large.height = widened(map.height);
  large.exg = widened(map.exg);
  large.colour = widened(map.colour);
  return large;
}

TEST_F(StripScoreTest, EmptyCellsAroundTheMapMakeAPlaceNoMoreSignificant) {
  const map::GridMap large = padded(scene_.fixed, 300);
  const MapSignals fixed(large, {});
  const StripScore score(fixed.at(kFactor), moving_.at(kFactor), fixed.filter(kFactor, {}));
  const double here = score_.significance(scene_.pose);
  EXPECT_NEAR(score.significance(scene_.pose), here, 0.1 * here);
}

}  // namespace
}  // namespace agricolmap::correlation
