#include "agricolmap/verdict/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/correlation/map_signals.hpp"
#include "agricolmap/map/test_scene.hpp"

namespace agricolmap::verdict {
namespace {

using ::testing::HasSubstr;
using testing::shifted;
using testing::TestField;
using testing::TestScene;

constexpr int kFactor = 3;
constexpr double kLength = 8.0;
const testing::TestError kGuess{{0.6, -0.4}, 0.05, 1.04, 0.97};

template <typename Offset>
TestScene sceneWith(const TestField& field, const Offset& offset) {
  return testing::bentScene(field, kGuess, kLength, 20, offset);
}

PartsReport partsOf(const TestScene& scene, const Eigen::Affine2d& pose) {
  const correlation::MapSignals fixed(scene.fixed, {});
  const correlation::MapSignals moving(scene.moving, {});
  const correlation::StripScore score(fixed.at(kFactor), moving.at(kFactor),
                                      fixed.filter(kFactor, {}));
  return findDisplacedParts(score, pose);
}

PartsReport partsOf(const TestScene& scene) { return partsOf(scene, scene.pose); }

const TestField kField{.size = 13.0};

/// Distances along the strip from the western end, whichever end of its frame that is.
std::pair<double, double> fromWest(const DisplacedPart& part, const PartsReport& report) {
  if (report.along.x() > 0.0) return {part.begin, part.end};
  return {report.length - part.end, report.length - part.begin};
}

TEST(Parts, AStripThatLiesRightHasNone) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    TestField field = kField;
    field.seed = seed;
    const PartsReport report =
        partsOf(sceneWith(field, [](double) { return Eigen::Vector2d(0.0, 0.0); }));
    EXPECT_TRUE(report.displaced.empty()) << describe(report);
    EXPECT_EQ(report.rms, 0.0);
    EXPECT_EQ(report.probability, 1.0);
    EXPECT_NEAR(report.length, kLength, 0.2);
  }
}

TEST(Parts, ASlipIsFoundWithItsPlaceAndSize) {
  const Eigen::Vector2d offset(-0.1, 0.3);
  const PartsReport report = partsOf(
      sceneWith(kField, [&](double x) { return x > 5.0 ? offset : Eigen::Vector2d(0.0, 0.0); }));
  ASSERT_EQ(report.displaced.size(), 1U);
  const DisplacedPart& part = report.displaced.front();
  const auto [begin, end] = fromWest(part, report);
  EXPECT_NEAR(begin, 5.0, 0.8);
  EXPECT_NEAR(end, kLength, 0.2);
  EXPECT_LT((part.offset - offset).norm(), 0.02) << part.offset.transpose();
  EXPECT_GT(part.significance, 6.0);
  EXPECT_NEAR(report.rms, offset.norm() * std::sqrt(3.0 / kLength), 0.03);
  EXPECT_LT(report.probability, 0.01);
  EXPECT_THAT(describe(report), HasSubstr("m at the strip's eastern end lie 0.3"));
  EXPECT_THAT(describe(report), HasSubstr("m further north than the whole says"));
}

TEST(Parts, ATenthOfAMetreIsEnough) {
  for (const Eigen::Vector2d& offset : {Eigen::Vector2d(0.1, 0.0), {0.0, 0.1}, {-0.07, 0.07}}) {
    const PartsReport report = partsOf(
        sceneWith(kField, [&](double x) { return x < 4.0 ? offset : Eigen::Vector2d(0.0, 0.0); }));
    ASSERT_EQ(report.displaced.size(), 1U) << offset.transpose();
    EXPECT_LT((report.displaced.front().offset - offset).norm(), 0.02);
    EXPECT_GT(report.rms, 0.05);
  }
}

TEST(Parts, APartInTheMiddleIsFound) {
  const PartsReport report = partsOf(sceneWith(kField, [](double x) {
    return x > 2.5 && x < 5.5 ? Eigen::Vector2d(0.25, 0.0) : Eigen::Vector2d(0.0, 0.0);
  }));
  ASSERT_EQ(report.displaced.size(), 1U);
  EXPECT_THAT(describe(report), HasSubstr("m of the strip, "));
}

TEST(Parts, ACompromiseIsUndoneForTheLargerPart) {
  // The pose halves the slip and turns by what the rest of it looks like.
  const TestScene scene = sceneWith(kField, [](double x) {
    const Eigen::Vector2d slip(0.0, x > 5.0 ? 0.25 : 0.0);
    return Eigen::Vector2d(slip - Eigen::Vector2d(0.0, 0.11 + 0.03 * (x - 4.0)));
  });
  const PartsReport report = partsOf(scene);
  EXPECT_TRUE(report.apart());
  ASSERT_TRUE(report.larger.has_value());
  const PartsReport laid = partsOf(scene, *report.larger);
  ASSERT_EQ(laid.displaced.size(), 1U) << describe(laid);
  EXPECT_NEAR(laid.displaced.front().offset.y(), 0.25, 0.04);
  EXPECT_FALSE(laid.larger.has_value() &&
               (laid.larger->translation() - report.larger->translation()).norm() > 0.04);
}

TEST(Parts, ASmoothBendIsNone) {
  const PartsReport report = partsOf(sceneWith(
      kField, [](double x) { return Eigen::Vector2d(0.0, 0.04 * std::cos(x / kLength * 6.3)); }));
  EXPECT_LT(report.rms, 0.05) << describe(report);
}

TEST(Parts, RowsThatRepeatCloselyAreNone) {
  const TestField wheat{.size = 13.0, .rows = 0.125, .plants = 0.03, .leaf = 0.015, .gaps = 0.05};
  const PartsReport report =
      partsOf(sceneWith(wheat, [](double) { return Eigen::Vector2d(0.0, 0.0); }));
  EXPECT_TRUE(report.displaced.empty()) << describe(report);
}

TEST(Parts, WhatLiesBeyondTheMapIsNone) {
  const TestScene scene = sceneWith(kField, [](double) { return Eigen::Vector2d(0.0, 0.0); });
  TestScene cut = scene;
  cut.fixed = map::croppedMap(
      scene.fixed, map::Box2(Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(scene.middle.x(), 13.0)));
  const PartsReport report = partsOf(cut);
  EXPECT_TRUE(report.displaced.empty()) << describe(report);
  EXPECT_TRUE(partsOf(scene, shifted(scene.pose, {100.0, 0.0})).displaced.empty());
}

TEST(Parts, AStripOfAnotherFieldHasNone) {
  TestField other = kField;
  other.seed = 77;
  TestScene scene = testing::testScene(other, kGuess, kLength);
  scene.fixed = testing::testScene(kField, kGuess, kLength).fixed;
  const PartsReport report = partsOf(scene);
  EXPECT_TRUE(report.displaced.empty()) << describe(report);
}

TEST(Parts, AreNamedByTheCompass) {
  PartsReport report;
  report.length = 10.0;
  report.along = Eigen::Vector2d(0.0, -1.0);
  report.displaced = {{.begin = 0.0, .end = 4.0, .offset = {-0.2, 0.2}},
                      {.begin = 6.0, .end = 8.0, .offset = {0.0, -0.5}}};
  EXPECT_EQ(describe(report),
            "the 4.0 m at the strip's northern end lie 0.28 m further north-west than the whole "
            "says (and 1 more part elsewhere)");
  report.displaced.erase(report.displaced.begin());
  EXPECT_EQ(describe(report),
            "2.0 m of the strip, 6.0 m from its northern end, lie 0.50 m further south than the "
            "whole says");
  report.displaced.clear();
  EXPECT_EQ(describe(report), "");
}

}  // namespace
}  // namespace agricolmap::verdict
