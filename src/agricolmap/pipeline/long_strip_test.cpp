#include "agricolmap/pipeline/long_strip.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/pieces/anchors.hpp"
namespace agricolmap::pipeline {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kCell = 0.1;

/// A map that is seen everywhere, brighter and darker by turns from `telling` [m] on along x.
map::GridMap mapOf(const map::Box2& box, double telling = -1e9) {
  map::GridMap map;
  map.frame = {box.min(), kCell, static_cast<int>(std::lround(box.sizes().y() / kCell)),
               static_cast<int>(std::lround(box.sizes().x() / kCell))};
  map.weight = Raster<float>(map.frame.rows, map.frame.cols, 1.0F);
  map.height = Raster<float>(map.frame.rows, map.frame.cols);
  map.exg = map.height;
  map.colour = Raster<Rgb>(map.frame.rows, map.frame.cols);
  map.filled = map.weight.size();
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      if (map.frame.centre(r, c).x() < telling) continue;
      map.exg(r, c) = (r / 3 + c / 3) % 2 == 0 ? 0.3F : 0.0F;
    }
  }
  return map;
}

PairMaps pairOf(double length, double telling = -1e9) {
  PairMaps maps;
  maps.frames.levelled_from_moving.setIdentity();
  maps.moving_box = map::Box2(Eigen::Vector2d(0.0, -1.0), Eigen::Vector2d(length, 1.0));
  maps.fixed_box = map::Box2(Eigen::Vector2d(-20.0, -30.0), Eigen::Vector2d(length + 20.0, 30.0));
  maps.moving = mapOf(maps.moving_box, telling);
  maps.fixed = mapOf(maps.fixed_box);
  maps.space.centre = maps.moving_box.center();
  return maps;
}

std::vector<double> anchorsIn(const PairMaps& maps, const RegistrationOptions& options) {
  const deform::Path path({{0.0, 0.0}, {maps.moving_box.max().x(), 0.0}});
  return pieces::anchorsOf(path, map::makeSignalMap(maps.moving, 1, options.signal),
                           options.search.max_length, !options.prior.anywhere());
}

TEST(LongStrip, IsLookedForInItsMiddleFirstWhereThereIsAGuess) {
  RegistrationOptions options;
  const PairMaps maps = pairOf(60.0);
  EXPECT_THAT(anchorsIn(maps, options), ElementsAre(30.0, 18.0, 42.0));
  // Where its middle shows nothing, what does.
  for (const double along : anchorsIn(pairOf(60.0, 40.0), options)) {
    EXPECT_GT(along, 35.0);
    break;
  }
}

TEST(LongStrip, APieceIsLookedForOnlyWhereTheGuessLeavesIt) {
  RegistrationOptions options;
  const PairMaps maps = pairOf(60.0);
  const deform::Path path({{0.0, 0.0}, {60.0, 0.0}});
  const auto middle = mapsOfPiece(maps, path, 30.0, options);
  ASSERT_TRUE(middle);
  EXPECT_LT(middle->fixed.frame.cols * kCell, 35.0);
  EXPECT_NEAR(static_cast<double>(middle->moving.filled), 12.0 * 2.0 / (kCell * kCell), 60.0);
  const auto end = mapsOfPiece(maps, path, 6.0, options);
  ASSERT_TRUE(end);
  EXPECT_GT(end->space.uncertainty.translation, middle->space.uncertainty.translation + 5.0);
  PairMaps elsewhere = pairOf(60.0);
  elsewhere.fixed.frame.corner.y() += 500.0;
  EXPECT_FALSE(mapsOfPiece(elsewhere, path, 30.0, options));
}

TEST(LongStrip, EndsThatWereNotFoundAreNamedWhereTheMapShowsThem) {
  const PairMaps maps = pairOf(60.0);
  const map::SignalMap fixed = map::makeSignalMap(maps.fixed, 1, {});
  const deform::Path path({{0.0, 0.0}, {60.0, 0.0}});
  FollowedPieces followed;
  followed.chain = pieces::cutPath(60.0, {});
  for (pieces::PiecePose& piece : followed.chain) piece.held = piece.middle() < 40.0;
  const auto lost = lostEnd(followed, path, fixed);
  ASSERT_TRUE(lost);
  EXPECT_THAT(lost->words, HasSubstr("the last"));
  EXPECT_NEAR(lost->length, 17.0, 4.0);
  for (pieces::PiecePose& piece : followed.chain) piece.pose.translation().y() = 100.0;
  EXPECT_FALSE(lostEnd(followed, path, fixed));
  for (pieces::PiecePose& piece : followed.chain) piece.held = true;
  EXPECT_FALSE(lostEnd(followed, path, fixed));
}

TEST(WithDrift, ComesOnTopOfWhatTheGuessMayBeWrongBy) {
  const PriorUncertainty prior{.translation = 5.0, .heading_deg = 10.0, .scale = 0.3};
  const PriorUncertainty drifted = withDrift(prior, 0.04);
  EXPECT_EQ(drifted.translation, 5.0);
  EXPECT_NEAR(drifted.heading_deg, 10.0 + degrees(0.04), 1e-12);
  EXPECT_NEAR(logScaleLimit(drifted), logScaleLimit(prior) - std::log(1.0 - 0.04), 1e-12);
  EXPECT_EQ(withDrift(PriorUncertainty::none(), 0.04).heading_deg, 180.0);
  EXPECT_NEAR(withDrift(prior, 0.0).scale, prior.scale, 1e-12);
}

TEST(PathOf, IsGivenOrThatOfALongStripsShape) {
  RegistrationOptions options;
  Cloud moving;
  moving.name = "robot.ply";
  Monitor monitor;
  const PairMaps short_strip = pairOf(8.0);
  EXPECT_FALSE(pathOf(moving, {}, short_strip, options, monitor));
  const std::vector<Eigen::Vector3d> places = {{0.0, 0.1, 0.0}, {8.0, 0.1, 0.0}};
  const auto driven = pathOf(moving, places, short_strip, options, monitor);
  ASSERT_TRUE(driven);
  EXPECT_NEAR(driven->length(), 8.0, 0.2);
  EXPECT_TRUE(monitor.warnings().empty());
  RegistrationOptions by_flow = options;
  by_flow.association = AssociationKind::kFlow;
  EXPECT_FALSE(pathOf(moving, places, short_strip, by_flow, monitor));
  ASSERT_EQ(monitor.warnings().size(), 1U);
  EXPECT_THAT(monitor.warnings()[0], HasSubstr("no difference"));
  const PairMaps maps = pairOf(40.0);
  const auto shape = pathOf(moving, {}, maps, options, monitor);
  ASSERT_TRUE(shape);
  EXPECT_NEAR(shape->length(), 40.0, 1.0);
  // As far as the strip shows it.
  const auto given = pathOf(moving, {{-7.0, 0.2, 5.0}, {39.0, 0.2, 5.0}}, maps, options, monitor);
  ASSERT_TRUE(given);
  EXPECT_NEAR(given->length(), 40.0, 0.2);
  EXPECT_THROW(pathOf(moving, {{0.0, 90.0, 0.0}, {40.0, 90.0, 0.0}}, maps, options, monitor),
               InputError);
  // A blob says what helps.
  PairMaps blob = pairOf(40.0);
  blob.moving_box = map::Box2(Eigen::Vector2d(0.0, -15.0), Eigen::Vector2d(30.0, 15.0));
  blob.moving = mapOf(blob.moving_box);
  EXPECT_FALSE(pathOf(moving, {}, blob, options, monitor));
  EXPECT_THAT(monitor.warnings().back(), HasSubstr("give a path"));
}

TEST(TurnAlong, LaysALongStripAlongTheXAxisAndLeavesOthers) {
  const auto lineOf = [](double length, double width) {
    Cloud cloud;
    for (double s = 0.0; s < length; s += 0.05) {
      const double aside = width * (std::fmod(s * 7.7, 1.0) - 0.5);
      const double heading = radians(30.0);
      cloud.xyz.emplace_back(static_cast<float>(s * std::cos(heading) - aside * std::sin(heading)),
                             static_cast<float>(s * std::sin(heading) + aside * std::cos(heading)),
                             0.0F);
    }
    return cloud;
  };
  const Eigen::Affine3d guess = Eigen::Affine3d::Identity();
  const Cloud fixed;
  EXPECT_NEAR(degrees(turnAlong(factsOf(fixed), lineOf(60.0, 2.0), guess, {}, 24.0)), -30.0, 0.3);
  EXPECT_EQ(turnAlong(factsOf(fixed), lineOf(20.0, 2.0), guess, {}, 24.0), 0.0);
  EXPECT_EQ(turnAlong(factsOf(fixed), lineOf(60.0, 40.0), guess, {}, 24.0), 0.0);
  EXPECT_EQ(turnAlong(factsOf(fixed), lineOf(60.0, 2.0), guess, PriorUncertainty::none(), 24.0),
            0.0);
}

}  // namespace
}  // namespace agricolmap::pipeline
