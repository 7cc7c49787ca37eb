#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "agricolmap/change/totals.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::change {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kCell = 0.05;

MapHeights flatMap(int rows, int cols, float height, float plane_error, float height_error) {
  return {Raster<float>(rows, cols, height), Raster<float>(rows, cols, plane_error),
          Raster<float>(rows, cols, height_error), Raster<std::uint16_t>(rows, cols, 1)};
}

/// A map of `slope` to the east.
MapHeights slopedMap(int rows, int cols, double slope, float plane_error, float height_error) {
  MapHeights map = flatMap(rows, cols, 0.0F, plane_error, height_error);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) map.surface(r, c) = static_cast<float>(slope * kCell * c);
  }
  return map;
}

TEST(SlopeError, IsHalfThePlaneErrorAlongASlope) {
  // p²/2 of a displacement's mean square p² falls along the slope.
  for (const float plane : {0.01F, 0.05F, 0.2F}) {
    const MapHeights map = slopedMap(21, 21, 0.5, plane, 0.0F);
    const Raster<float> error = slopeError(map.surface, map.plane_error, kCell);
    EXPECT_NEAR(error(10, 10), 0.5 * static_cast<double>(plane) / std::sqrt(2.0), 1e-5) << plane;
  }
}

TEST(SlopeError, IsNoLargerThanWhatStandsThere) {
  // Plants 10 cm high and as wide: 1 m beside its place, a cell is wrong by 10 cm at most.
  MapHeights map = flatMap(81, 81, 0.0F, 1.0F, 0.0F);
  for (int r = 0; r < 81; ++r) {
    for (int c = 0; c < 81; ++c) map.surface(r, c) = (r / 2 + c / 2) % 2 == 0 ? 0.1F : 0.0F;
  }
  for (const float error : slopeError(map.surface, map.plane_error, kCell)) {
    EXPECT_LE(error, 0.1F + 1e-6F);
  }
}

TEST(SlopeError, IsNotKnownOfALoneCell) {
  Raster<float> surface(5, 5, kNone);
  surface(2, 2) = 1.0F;
  EXPECT_TRUE(std::isnan(slopeError(surface, Raster<float>(5, 5, 0.1F), kCell)(2, 2)));
  EXPECT_EQ(slopeError(surface, Raster<float>(5, 5, 0.0F), kCell)(2, 2), 0.0F);
}

TEST(HeightChange, HasALevelOfItsOwnAtEveryCell) {
  const MapHeights a = slopedMap(9, 9, 0.2, 0.03F, 0.01F);
  MapHeights b = slopedMap(9, 9, 0.2, 0.04F, 0.02F);
  b.height_error(4, 4) = 0.1F;
  for (float& value : b.surface) value += 0.06F;
  b.surface(0, 0) = kNone;
  b.height_error(0, 1) = kNone;
  const HeightChange change = heightChange(a, b, kCell);
  const double level = 1.96 * std::sqrt(0.01 * 0.01 + 0.02 * 0.02 + 0.5 * 0.04 * 0.05 * 0.05);
  EXPECT_NEAR(change.change(3, 3), 0.06, 1e-6);
  EXPECT_NEAR(change.detection(3, 3), level, 1e-6);
  EXPECT_EQ(change.significant(3, 3), 1.0F);
  EXPECT_EQ(change.significant(4, 4), 0.0F);
  for (const auto* raster : {&change.change, &change.detection, &change.significant}) {
    EXPECT_TRUE(std::isnan((*raster)(0, 0)));
    EXPECT_TRUE(std::isnan((*raster)(0, 1)));
  }
  const HeightChange apart = heightChange(a, b, kCell, {.plane = 0.0, .height = 0.05});
  EXPECT_NEAR(apart.detection(3, 3), std::hypot(level, 1.96 * 0.05), 1e-6);
  EXPECT_EQ(apart.significant(3, 3), 0.0F);
}

/// What is expected of the errors is what they are: noise of each cell, and one shift of each map.
TEST(HeightChange, CallsOneInTwentyUnchangedCellsChanged) {
  Random random(7);
  const auto noise = [&](double sigma) { return static_cast<float>(random.normal(sigma)); };
  std::size_t called = 0;
  std::size_t all = 0;
  constexpr int kTrials = 400;
  for (int trial = 0; trial < kTrials; ++trial) {
    MapHeights a = flatMap(12, 12, 0.0F, 0.0F, 0.02F);
    MapHeights b = flatMap(12, 12, 0.0F, 0.0F, 0.03F);
    const float shift = noise(0.024);
    for (float& value : a.surface) value += noise(0.02);
    for (float& value : b.surface) value += shift + noise(0.018);
    const HeightChange change = heightChange(a, b, kCell);
    for (const float significant : change.significant) called += significant > 0.0F ? 1U : 0U;
    all += change.significant.size();
  }
  const double share = static_cast<double>(called) / static_cast<double>(all);
  EXPECT_NEAR(share, 0.05, 0.01);
}

Totals totals(const MapHeights& a, const MapHeights& b, const FrameError& frames = {},
              const Raster<std::uint8_t>* stable = nullptr) {
  return totalsOf(heightChange(a, b, kCell, frames), a, b, kCell, frames, stable);
}

TEST(Totals, CountRiseAndFallApart) {
  const MapHeights a = flatMap(10, 10, 1.0F, 0.0F, 0.01F);
  MapHeights b = flatMap(10, 10, 1.0F, 0.0F, 0.01F);
  for (int c = 0; c < 10; ++c) {
    b.surface(2, c) = 1.2F;
    b.surface(7, c) = 0.9F;
  }
  b.surface(0, 0) = kNone;
  const Totals t = totals(a, b);
  EXPECT_EQ(t.compared.cells, 99U);
  EXPECT_EQ(t.rise.cells, 10U);
  EXPECT_NEAR(t.rise.area, 0.025, 1e-9);
  EXPECT_NEAR(t.rise.volume, 0.2 * 0.025, 1e-7);
  EXPECT_NEAR(t.rise.median, 0.2, 1e-6);
  EXPECT_NEAR(t.fall.volume, -0.1 * 0.025, 1e-7);
  EXPECT_NEAR(t.compared.volume, t.rise.volume + t.fall.volume, 1e-9);
  EXPECT_FALSE(t.stable.has_value());
}

TEST(Totals, NumbersOfCellsMakeNoSourceSurer) {
  const auto deviation = [](int side) {
    const MapHeights a = flatMap(side, side, 0.0F, 0.0F, 0.03F);
    const MapHeights b = flatMap(side, side, 0.1F, 0.0F, 0.04F);
    return totals(a, b).compared.meanDeviation();
  };
  EXPECT_NEAR(deviation(4), 0.05, 1e-7);
  EXPECT_NEAR(deviation(40), 0.05, 1e-7);
}

TEST(Totals, SourcesErrApart) {
  const MapHeights a = flatMap(10, 10, 0.0F, 0.0F, 0.0F);
  MapHeights b = flatMap(10, 10, 0.1F, 0.0F, 0.04F);
  for (int c = 0; c < 10; ++c) {
    for (int r = 0; r < 5; ++r) b.source(r, c) = 2;
  }
  EXPECT_NEAR(totals(a, b).compared.meanDeviation(), 0.04 / std::sqrt(2.0), 1e-7);
  EXPECT_NEAR(totals(a, b, {.plane = 0.0, .height = 0.03}).compared.meanDeviation(),
              std::hypot(0.04 / std::sqrt(2.0), 0.03), 1e-7);
}

/// Of a hump, all of which is seen, a displacement changes no volume; of a slope it does.
TEST(Totals, WhatIsShiftedLeavesHereAndArrivesThere) {
  const MapHeights a = flatMap(41, 41, 0.0F, 0.0F, 0.0F);
  MapHeights hump = flatMap(41, 41, 0.0F, 0.05F, 0.0F);
  for (int r = 0; r < 41; ++r) {
    for (int c = 0; c < 41; ++c) {
      const double d = std::hypot(r - 20.0, c - 20.0);
      hump.surface(r, c) = static_cast<float>(0.3 * std::exp(-d * d / 40.0));
    }
  }
  EXPECT_NEAR(totals(a, hump).compared.meanDeviation(), 0.0, 1e-5);
  const MapHeights sloped = slopedMap(41, 41, 0.2, 0.05F, 0.0F);
  // Edges have no central difference.
  EXPECT_NEAR(totals(a, sloped).compared.meanDeviation(), 0.2 * 0.05 / std::sqrt(2.0), 5e-4);
}

TEST(ZoneChanges, AreTotalsOfTheirCells) {
  const MapHeights a = slopedMap(10, 10, 0.1, 0.02F, 0.01F);
  MapHeights b = slopedMap(10, 10, 0.1, 0.02F, 0.01F);
  for (int c = 0; c < 10; ++c) b.surface(2, c) += 0.2F;
  Raster<std::int32_t> zones(10, 10, -1);
  for (int r = 0; r < 10; ++r) {
    for (int c = 0; c < 8; ++c) zones(r, c) = c < 4 ? 0 : 2;
  }
  const HeightChange change = heightChange(a, b, kCell);
  const std::vector<ZoneChange> found = zoneChanges(change, a, b, kCell, {}, zones, 3);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].compared.cells, 40U);
  EXPECT_EQ(found[0].rise.cells, 4U);
  EXPECT_EQ(found[0].fall.cells, 0U);
  EXPECT_NEAR(found[0].compared.mean(), 0.02, 1e-6);
  EXPECT_EQ(found[1].compared.cells, 0U);
  EXPECT_EQ(found[2].compared.volume, found[0].compared.volume);
  // One zone of all cells is the field.
  const Raster<std::int32_t> all(10, 10, 0);
  const ZoneChange whole = zoneChanges(change, a, b, kCell, {}, all, 1).front();
  const Totals t = totalsOf(change, a, b, kCell, {}, nullptr);
  EXPECT_EQ(whole.compared.volume, t.compared.volume);
  EXPECT_EQ(whole.compared.deviation, t.compared.deviation);
  EXPECT_EQ(whole.rise.cells, t.rise.cells);
}

TEST(Totals, LookAtWhatShouldNotHaveChanged) {
  const MapHeights a = flatMap(4, 4, 0.0F, 0.0F, 0.01F);
  const MapHeights b = flatMap(4, 4, 0.02F, 0.0F, 0.01F);
  Raster<float> cover(4, 4, 0.6F);
  cover(1, 1) = 0.0F;
  cover(1, 2) = kNone;
  const Raster<std::uint8_t> bare = bareGround(cover, cover);
  const Totals t = totals(a, b, {}, &bare);
  ASSERT_TRUE(t.stable.has_value());
  EXPECT_EQ(t.stable->cells, 1U);
  EXPECT_NEAR(t.stable->mean(), 0.02, 1e-7);
  EXPECT_NEAR(t.stable->meanDeviation(), std::hypot(0.01, 0.01), 1e-7);
}

TEST(Totals, AreZeroWhereNothingCouldBeCompared) {
  const MapHeights a = flatMap(4, 4, kNone, 0.0F, 0.01F);
  const Totals t = totals(a, a);
  EXPECT_EQ(t.compared.cells, 0U);
  EXPECT_EQ(t.compared.mean(), 0.0);
  EXPECT_EQ(t.rise.deviation, 0.0);
}

}  // namespace
}  // namespace agricolmap::change
