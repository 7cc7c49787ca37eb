#include "agricolmap/locate/correlation_search.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "agricolmap/map/test_field.hpp"
#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::locate {
namespace {

using testing::growField;
using testing::guessError;
using testing::TestField;
using testing::Truth;
using testing::viewOf;

struct Sought {
  Eigen::Vector2d shift;
  double yaw;
  double scale_x;
  double scale_y;
};

/// Largest distance [m] of the corners from where they belong as the best placement lays them, for
/// a strip of 5 × 1.6 m in a field of `field.size`, and the guess wrong by `error`.
double worstCorner(const TestField& field, const Sought& error) {
  const Truth truth = growField(field);
  const Eigen::Vector2d middle = Eigen::Vector2d::Constant(0.5 * field.size);
  const Eigen::Affine2d fixed_from_moving =
      guessError(middle, error.shift, error.yaw, error.scale_x, error.scale_y);
  const map::GridMap fixed = viewOf(
      truth, field, map::Box2(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(field.size)),
      Eigen::Affine2d::Identity(), 0.02, 11);
  const map::GridMap moving =
      viewOf(truth, field,
             map::Box2(middle - Eigen::Vector2d(2.5, 0.8), middle + Eigen::Vector2d(2.5, 0.8)),
             fixed_from_moving, 0.05, 12);
  SearchSpace space;
  space.centre = middle;
  const correlation::MapSignals fixed_signals(fixed, {});
  const correlation::MapSignals moving_signals(moving, {});
  const SearchResult result = searchByCorrelation(
      fixed_signals, moving_signals, rowWaves(fixed_signals, moving_signals), space, {});
  if (result.placements.empty()) return 1e9;
  const Eigen::Affine2d& pose = result.placements.front().pose;
  double worst = 0.0;
  for (const double x : {-2.5, 2.5}) {
    for (const double y : {-0.8, 0.8}) {
      const Eigen::Vector2d corner = middle + Eigen::Vector2d(x, y);
      worst = std::max(worst, (fixed_from_moving * corner - pose * corner).norm());
    }
  }
  return worst;
}

TEST(CorrelationSearch, FindsAStripWhoseGuessIsAsWrongAsThePaperAllows) {
  TestField field;
  field.seed = 21;
  EXPECT_LT(worstCorner(field, {{4.0, -3.0}, 0.2, 1.3, 0.75}), 0.15);
  EXPECT_LT(worstCorner(field, {{-3.0, 4.0}, -0.2, 0.75, 1.3}), 0.15);
}

// A map smaller than what the guess allows: circular correlation repeats every place one period
// away, and the search must know which of the two lies in the map.
TEST(CorrelationSearch, AMapSmallerThanTheSearchHasNoSecondPlace) {
  TestField field;
  field.size = 6.0;
  field.seed = 22;
  for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0.0, 1.2), {0.0, -1.2}, {0.3, 0.8}}) {
    EXPECT_LT(worstCorner(field, {shift, 0.03, 0.95, 1.05}), 0.15) << shift.transpose();
  }
}

TEST(CorrelationSearch, MirroredCopiesOfTheStripFitNowhere) {
  const testing::TestScene scene =
      testing::testScene({.size = 12.0}, {{0.6, -0.4}, 0.05, 1.06, 0.95});
  const correlation::MapSignals fixed(scene.fixed, {});
  const correlation::MapSignals moving(scene.moving, {});
  const RowWaves waves = rowWaves(fixed, moving);
  SearchSpace space;
  space.centre = scene.middle;
  const double right =
      searchByCorrelation(fixed, moving, waves, space, {}).placements.front().score;
  const std::vector<Eigen::Matrix2d> mirrors = decoyMirrors(moving, waves, space);
  ASSERT_EQ(mirrors.size(), 2U);
  SearchSpace any = space;
  any.uncertainty.heading_deg = 180.0;
  EXPECT_EQ(decoyMirrors(moving, waves, any).size(), 1U);
  for (const Eigen::Matrix2d& mirror : mirrors) {
    EXPECT_LT(mirror.determinant(), 0.0);
    space.mirror = mirror;
    const SearchResult decoy = searchByCorrelation(fixed, moving, waves, space, {});
    ASSERT_FALSE(decoy.placements.empty());
    EXPECT_LT(decoy.placements.front().pose.linear().determinant(), 0.0);
    EXPECT_LT(decoy.placements.front().score, 0.7 * right);
    EXPECT_GT(decoy.placements.front().score, 2.0);
    // A part of the headings and scales tells nearly as much: of all, for rows leave but a dozen.
    CorrelationOptions some;
    some.rows_on_rows = false;
    const std::size_t all =
        searchByCorrelation(fixed, moving, waves, space, some).report.correlations;
    some.share = 0.125;
    const SearchResult thinned = searchByCorrelation(fixed, moving, waves, space, some);
    ASSERT_FALSE(thinned.placements.empty());
    EXPECT_LT(thinned.report.correlations, all / 2);
    EXPECT_GT(thinned.placements.front().score, 0.6 * decoy.placements.front().score);
  }
}

}  // namespace
}  // namespace agricolmap::locate
