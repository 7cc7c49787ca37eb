#include "agricolmap/map/footprint.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::map {
namespace {

const Eigen::Affine3d kLevel = Eigen::Affine3d::Identity();

/// Adds `count` points on the rectangle from (x, y).
void addPatch(Cloud& cloud, double x, double y, double width, double height, std::size_t count) {
  Random random(cloud.size() + 1);
  for (std::size_t i = 0; i < count; ++i) {
    cloud.xyz.push_back(Eigen::Vector3d(x + random.uniform(0, width), y + random.uniform(0, height),
                                        random.normal(0.02))
                            .cast<float>());
  }
}

/// A strip of 10 × 2 m.
Cloud strip(std::size_t points = 100000) {
  Cloud cloud;
  addPatch(cloud, 0, 0, 10, 2, points);
  return cloud;
}

void expectSameBox(const Box2& box, const Box2& expected) {
  EXPECT_EQ(box.min(), expected.min());
  EXPECT_EQ(box.max(), expected.max());
}

TEST(Footprint, FlyingPointsBesideTheStripChangeNothing) {
  const Footprint clean = footprintOf(strip(), kLevel);
  EXPECT_EQ(clean.left_out, 0U);
  EXPECT_LT(clean.box.max().x(), 10.001);
  for (const int fliers : {1, 20}) {
    Cloud cloud = strip();
    for (int i = 0; i < fliers; ++i) {
      const double angle = 0.9 * i, distance = 20.0 + 37.0 * i / 19.0;
      cloud.xyz.emplace_back(static_cast<float>(5.0 + distance * std::cos(angle)),
                             static_cast<float>(1.0 + distance * std::sin(angle)), 1.5F);
    }
    const Footprint footprint = footprintOf(cloud, kLevel);
    expectSameBox(footprint.box, clean.box);
    EXPECT_EQ(footprint.left_out, static_cast<std::size_t>(fliers));
    EXPECT_EQ(footprint.points, clean.points);
    EXPECT_EQ(footprint.area, clean.area);
  }
}

// At 15 km the first bins are larger than the strip and what flies 20 m beside it.
TEST(Footprint, FarPointsDoNotHideNearOnes) {
  Cloud cloud = strip();
  cloud.xyz.emplace_back(25.0F, 15.0F, 0.0F);
  cloud.xyz.emplace_back(15000.0F, -15000.0F, 0.0F);
  const Footprint footprint = footprintOf(cloud, kLevel);
  EXPECT_EQ(footprint.left_out, 2U);
  expectSameBox(footprint.box, footprintOf(strip(), kLevel).box);
}

TEST(Footprint, PartsFarApartAreBothTheMap) {
  Cloud cloud = strip();
  addPatch(cloud, 200, 300, 3, 2, 200);  // 0.2 %
  const Footprint footprint = footprintOf(cloud, kLevel);
  EXPECT_EQ(footprint.left_out, 0U);
  EXPECT_GT(footprint.box.max().x(), 202.0);
}

TEST(Footprint, AnLIsKeptWithItsArms) {
  Cloud cloud = strip();
  addPatch(cloud, 0, 0, 0.3, 30, 2000);
  const Footprint footprint = footprintOf(cloud, kLevel);
  EXPECT_EQ(footprint.left_out, 0U);
  EXPECT_GT(footprint.box.max().y(), 29.9);
  // A stray point inside its bounds changes nothing, and counts as nothing.
  cloud.xyz.emplace_back(6.0F, 20.0F, 0.0F);
  EXPECT_EQ(footprintOf(cloud, kLevel).left_out, 0U);
}

TEST(Footprint, OfSparseAndTinyCloudsNothingIsLeftOut) {
  Cloud sparse;
  addPatch(sparse, 0, 0, 200, 200, 5000);
  EXPECT_EQ(footprintOf(sparse, kLevel).left_out, 0U);
  for (const std::size_t points : {1, 2, 10}) {
    Cloud tiny;
    addPatch(tiny, 0, 0, 100, 100, points);
    const Footprint footprint = footprintOf(tiny, kLevel);
    EXPECT_EQ(footprint.points, points);
    EXPECT_EQ(footprint.left_out, 0U);
  }
  const Footprint none = footprintOf(Cloud{}, kLevel);
  EXPECT_TRUE(none.box.isEmpty());
  EXPECT_EQ(none.spacing(), 0.0);
}

TEST(Footprint, IsThatOfTheLevelledFrameAndOfOneThread) {
  const Eigen::Affine3d levelled =
      Eigen::Translation3d(3, 4, 5) *
      Eigen::AngleAxisd(1.0, Eigen::Vector3d(0.1, 0.2, 1.0).normalized());
  Cloud cloud = strip();
  cloud.xyz.emplace_back(50.0F, 1.0F, 0.0F);
  const Footprint many = footprintOf(cloud, levelled);
  EXPECT_EQ(many.left_out, 1U);
  EXPECT_TRUE(many.box.contains((levelled * Eigen::Vector3d(5, 1, 0)).head<2>().eval()));
  const ThreadLimit limit(1);
  const Footprint one = footprintOf(cloud, levelled);
  expectSameBox(one.box, many.box);
  EXPECT_EQ(one.area, many.area);
}

TEST(Footprint, SpacingIsRightOnLargeMapsToo) {
  Cloud lattice;
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < 200; ++j) {
      lattice.xyz.emplace_back(0.05F * static_cast<float>(i), 0.05F * static_cast<float>(j), 0.0F);
    }
  }
  EXPECT_NEAR(footprintOf(lattice, kLevel).spacing(), 0.05, 0.003);
  // 16 ha of 16 points a square metre.
  Cloud large;
  addPatch(large, 0, 0, 400, 400, 2'560'000);
  EXPECT_NEAR(footprintOf(large, kLevel).spacing(), 0.25, 0.01);
  // 6 × 6 km, more than the finest bins can hold.
  Cloud wide;
  addPatch(wide, 0, 0, 6000, 6000, 1'000'000);
  EXPECT_GT(footprintOf(wide, kLevel).spacing(), 0.5);
}

}  // namespace
}  // namespace agricolmap::map
