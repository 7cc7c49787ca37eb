#include "agricolmap/pieces/driven_path.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "agricolmap/core/error.hpp"

namespace agricolmap::pieces {
namespace {

using ::testing::HasSubstr;

/// A map of 60 × 60 m in cells of 0.2 m, seen where `seen` says.
map::SignalMap mapOf(const std::function<bool(const Eigen::Vector2d&)>& seen) {
  map::SignalMap map;
  map.frame = {{-30.0, -30.0}, 0.2, 300, 300};
  map.weight = Raster<float>(300, 300);
  for (int r = 0; r < 300; ++r) {
    for (int c = 0; c < 300; ++c) map.weight(r, c) = seen(map.frame.centre(r, c)) ? 1.0F : 0.0F;
  }
  return map;
}

bool nearTo(const deform::Path& path, const Eigen::Vector2d& point, double width) {
  const deform::PathPlace place = path.place(point);
  return std::abs(place.aside) < 0.5 * width && place.along > 0.0 && place.along < path.length();
}

TEST(PathOfShape, IsStraightInAStraightStripAndFollowsAnArc) {
  const deform::Path line({{-25.0, -10.0}, {25.0, 10.0}});
  const auto straight = pathOfShape(mapOf([&](const auto& p) { return nearTo(line, p, 2.2); }));
  ASSERT_TRUE(straight.path);
  EXPECT_EQ(straight.path->corners().size(), 2U);
  EXPECT_NEAR(straight.path->length(), line.length(), 1.0);
  const auto arc = pathOfShape(mapOf([](const Eigen::Vector2d& p) {
    const double radius = (p - Eigen::Vector2d(0.0, -40.0)).norm();
    return std::abs(radius - 45.0) < 1.1 && std::abs(p.x()) < 24.0;
  }));
  ASSERT_TRUE(arc.path);
  for (double s = 2.0; s < arc.path->length() - 2.0; s += 1.0) {
    EXPECT_NEAR((arc.path->point(s) - Eigen::Vector2d(0.0, -40.0)).norm(), 45.0, 0.3);
  }
}

TEST(PathOfShape, SaysWhyThereIsNoneAndWhatHelps) {
  const auto blob = pathOfShape(mapOf(
      [](const Eigen::Vector2d& p) { return std::abs(p.x()) < 10.0 && std::abs(p.y()) < 8.0; }));
  EXPECT_FALSE(blob.path);
  EXPECT_THAT(blob.why_not, HasSubstr("give a path"));
  const auto crossing = pathOfShape(mapOf([](const Eigen::Vector2d& p) {
    return std::min(std::abs(p.x() - p.y()), std::abs(0.3 * p.x() + p.y())) < 1.2;
  }));
  EXPECT_FALSE(crossing.path);
  EXPECT_THAT(crossing.why_not, HasSubstr("no single track"));
  EXPECT_THAT(crossing.why_not, HasSubstr("give a path"));
}

TEST(PathThrough, KeepsCornersThatMatterAndRefusesAPathBesideTheMap) {
  const deform::Path line({{-25.0, 0.0}, {25.0, 0.0}});
  const map::SignalMap map = mapOf([&](const auto& p) { return nearTo(line, p, 2.2); });
  std::vector<Eigen::Vector2d> places;
  for (double x = -25.0; x <= 25.0; x += 0.1) places.emplace_back(x, 0.01 * std::sin(x));
  EXPECT_LT(pathThrough(places, map, "robot").corners().size(), 5U);
  for (Eigen::Vector2d& place : places) place.y() += 20.0;
  try {
    pathThrough(places, map, "robot");
    ADD_FAILURE() << "no error";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("robot"));
    EXPECT_THAT(error.what(), HasSubstr("coordinates of the moving cloud's file"));
  }
  EXPECT_THROW(pathThrough({{1.0, 1.0}}, map, "robot"), InputError);
}

TEST(PathThrough, IsOfTheStretchThatTheMapShows) {
  const deform::Path strip({{-6.0, 0.0}, {6.0, 0.0}});
  const map::SignalMap map = mapOf([&](const auto& p) { return nearTo(strip, p, 2.2); });
  const deform::Path day = pathThrough({{-29.0, 20.0}, {-20.0, 0.0}, {20.0, 0.0}}, map, "robot");
  EXPECT_TRUE(day.straight());
  EXPECT_NEAR(day.length(), 12.0, 0.5);
  EXPECT_NEAR(day.point(0.0).x(), -6.0, 0.3);
  // A camera that looks ahead sees further than the robot goes.
  EXPECT_NEAR(pathThrough({{-5.0, 0.0}, {4.0, 0.0}}, map, "robot").length(), 12.0, 0.5);
}

TEST(DrivenTwice, TellsThereAndBackFromALine) {
  EXPECT_EQ(drivenTwice(deform::Path({{0.0, 0.0}, {40.0, 0.0}}), 2.5), 0.0);
  const deform::Path back({{0.0, 0.0}, {40.0, 0.0}, {40.0, 2.0}, {0.0, 2.0}});
  EXPECT_GT(drivenTwice(back, 2.5), 0.8);
  EXPECT_EQ(drivenTwice(back, 1.5), 0.0);
}

}  // namespace
}  // namespace agricolmap::pieces
