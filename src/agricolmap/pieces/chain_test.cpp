#include "agricolmap/pieces/chain.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/correlation/map_signals.hpp"
#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::pieces {
namespace {

using testing::TestField;
using testing::TestScene;

constexpr double kLength = 20.0;
const testing::TestError kGuess{{0.3, -0.2}, 0.0, 1.0, 1.0};
const TestField kField{.size = 23.0};
const PiecesOptions kPieces{.from = 10.0, .piece = 5.0, .drift = 0.04, .slip = 1.0};

template <typename Offset>
TestScene sceneWith(const Offset& offset) {
  return testing::bentScene(kField, kGuess, kLength, 25, offset);
}

struct Chained {
  std::vector<PiecePose> chain;
  std::optional<Joined> joined;
  deform::Path path;
};

Chained follow(const TestScene& scene, double from) {
  const correlation::MapSignals fixed(scene.fixed, {});
  const correlation::MapSignals moving(scene.moving, {});
  const refine::PairSignals signals(fixed, moving, {}, {});
  const GridFrame& frame = scene.moving.frame;
  const double middle = frame.corner.y() + 0.5 * frame.cell * frame.rows;
  const deform::Path path(
      {{frame.corner.x(), middle}, {frame.corner.x() + frame.cell * frame.cols, middle}});
  std::vector<PiecePose> chain = followPath(signals, path, from, scene.pose, kPieces, {});
  std::optional<Joined> result = joined(chain, path, 0.5);
  return {std::move(chain), std::move(result), path};
}

TEST(CutPath, CoversThePathByHalfOverlappingPieces) {
  const std::vector<PiecePose> pieces = cutPath(100.0, PiecesOptions{});
  ASSERT_EQ(pieces.size(), 24U);
  EXPECT_EQ(pieces.front().from, 0.0);
  EXPECT_NEAR(pieces.back().to, 100.0, 1e-9);
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    EXPECT_NEAR(pieces[i].from, pieces[i - 1].middle(), 1e-9);
  }
  EXPECT_EQ(cutPath(3.0, PiecesOptions{}).size(), 1U);
}

TEST(FollowPath, FollowsAStripThatBendsByDecimetresFromOneEndToTheOther) {
  const auto offset = [](double x) { return Eigen::Vector2d(0.001 * x * x, 0.0016 * x * x); };
  const TestScene scene = sceneWith(offset);
  const Chained found = follow(scene, 2.0);
  for (const PiecePose& piece : found.chain) {
    EXPECT_TRUE(piece.held) << piece.middle();
    const Eigen::Vector2d place = found.path.point(piece.middle());
    EXPECT_LT((piece.pose * place - scene.pose * place - offset(piece.middle())).norm(), 0.04)
        << piece.middle();
  }
  ASSERT_TRUE(found.joined);
  for (double x = 0.5; x < kLength; x += 0.5) {
    const Eigen::Vector2d place = found.path.point(x);
    const Eigen::Vector2d bent = found.joined->bend.bent({place.x(), place.y(), 0.0}).head<2>();
    EXPECT_LT((found.joined->pose * bent - scene.pose * place - offset(x)).norm(), 0.05) << x;
  }
  EXPECT_GT(found.joined->largest, 0.1);
}

TEST(FollowPath, GoesOnBehindASlip) {
  const TestScene scene = sceneWith(
      [](double x) { return x < 9.0 ? Eigen::Vector2d(0.0, 0.0) : Eigen::Vector2d(0.1, 0.5); });
  const Chained found = follow(scene, 2.0);
  const PiecePose& last = found.chain.back();
  EXPECT_TRUE(last.held);
  const Eigen::Vector2d place = found.path.point(last.middle());
  EXPECT_LT((last.pose * place - scene.pose * place - Eigen::Vector2d(0.1, 0.5)).norm(), 0.03);
}

TEST(DeviationOf, IsWhatNeighboursLayTheSharedApartBy) {
  const deform::Path path({{0.0, 0.0}, {20.0, 0.0}});
  std::vector<PiecePose> chain = cutPath(20.0, kPieces);
  EXPECT_EQ(deviationOf(chain, path), 0.0);  // none was found
  for (std::size_t i = 0; i < chain.size(); ++i) {
    chain[i].held = true;
    chain[i].pose = Eigen::Translation2d(i % 2 == 0 ? 0.01 : -0.01, 0.0);
  }
  EXPECT_NEAR(deviationOf(chain, path), 0.01, 1e-12);  // 2 cm apart along, 0 across
  for (PiecePose& piece : chain) piece.pose = Eigen::Rotation2Dd(0.1);
  EXPECT_NEAR(deviationOf(chain, path), 0.0, 1e-12);
}

TEST(FollowPath, WhatLiesNowhereIsNotHeld) {
  // Farther than any piece is looked for.
  const TestScene scene =
      sceneWith([](double x) { return Eigen::Vector2d(0.0, x < 9.0 ? 0.0 : 6.0); });
  const Chained found = follow(scene, 2.0);
  EXPECT_TRUE(found.chain.front().held);
  EXPECT_FALSE(found.chain.back().held);
  EXPECT_LT(significanceOf(found.chain),
            significanceOf(
                follow(sceneWith([](double) { return Eigen::Vector2d(0.0, 0.0); }), 2.0).chain));
}

}  // namespace
}  // namespace agricolmap::pieces
