#include "agricolmap/deform/path.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"

namespace agricolmap::deform {
namespace {

Path corner() { return Path({{0.0, 0.0}, {4.0, 0.0}, {4.0, 0.0}, {4.0, 3.0}}); }

TEST(Path, CountsItsLengthAlongTheCorners) {
  EXPECT_DOUBLE_EQ(corner().length(), 7.0);
  EXPECT_EQ(corner().corners().size(), 3U);
}

TEST(Path, TellsHowFarAlongAndAsideAPointLies) {
  const PathPlace before = corner().place({1.0, 0.5});
  EXPECT_DOUBLE_EQ(before.along, 1.0);
  EXPECT_DOUBLE_EQ(before.aside, 0.5);
  EXPECT_EQ(before.tangent, Eigen::Vector2d(1.0, 0.0));
  const PathPlace behind = corner().place({4.5, 2.0});
  EXPECT_DOUBLE_EQ(behind.along, 6.0);
  EXPECT_DOUBLE_EQ(behind.aside, -0.5);
}

TEST(Path, GoesStraightOnBeyondItsEnds) {
  EXPECT_DOUBLE_EQ(corner().place({-1.0, 0.2}).along, -1.0);
  EXPECT_DOUBLE_EQ(corner().place({4.1, 4.0}).along, 8.0);
}

TEST(Path, PutsAPlaceBackWhereItCameFrom) {
  const Path path = corner();
  for (const Eigen::Vector2d& point :
       {Eigen::Vector2d(0.3, 0.7), {3.0, -0.4}, {4.4, 2.2}, {-0.5, 0.1}}) {
    const PathPlace place = path.place(point);
    EXPECT_TRUE(path.point(place.along, place.aside).isApprox(point, 1e-12));
    EXPECT_EQ(path.tangent(place.along), place.tangent);
  }
}

TEST(Path, IsCutOrGoesStraightOn) {
  const Path middle = stretchOf(corner(), 1.0, 5.5);
  EXPECT_DOUBLE_EQ(middle.length(), 4.5);
  EXPECT_EQ(middle.corners().size(), 3U);
  EXPECT_TRUE(middle.point(4.5).isApprox(Eigen::Vector2d(4.0, 1.5)));
  const Path longer = stretchOf(corner(), -1.0, 8.0);
  EXPECT_DOUBLE_EQ(longer.length(), 9.0);
  EXPECT_TRUE(stretchOf(corner(), 1.0, 3.0).straight());
  EXPECT_THROW(stretchOf(corner(), 2.0, 2.0), UsageError);
}

TEST(Path, RefusesASinglePlace) {
  EXPECT_THROW(Path({{1.0, 1.0}, {1.0, 1.0}}), UsageError);
  EXPECT_THROW(Path({}), UsageError);
}

TEST(Path, OfAStripIsItsMiddleLine) {
  map::StripFrame strip;
  strip.centre = {2.0, 1.0};
  strip.half_extent = {5.0, 1.0};
  const Path path = straightPath(strip);
  EXPECT_DOUBLE_EQ(path.length(), 10.0);
  EXPECT_DOUBLE_EQ(path.place({2.0, 1.5}).along, 5.0);
  EXPECT_DOUBLE_EQ(path.place({2.0, 1.5}).aside, 0.5);
}

}  // namespace
}  // namespace agricolmap::deform
