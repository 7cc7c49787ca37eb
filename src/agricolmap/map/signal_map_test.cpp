#include "agricolmap/map/signal_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace agricolmap::map {
namespace {

/// 4 × 4 m at 2 cm: a gentle slope plus rows 50 cm apart, greenness from the rows.
GridMap makeRows(bool with_hole) {
  GridMap map;
  map.frame = {{0, 0}, 0.02, 200, 200};
  map.weight = Raster<float>(200, 200, 1.0F);
  map.height = Raster<float>(200, 200);
  map.exg = Raster<float>(200, 200);
  map.colour = Raster<Rgb>(200, 200);
  for (int r = 0; r < 200; ++r) {
    for (int c = 0; c < 200; ++c) {
      const double y = 0.02 * (r + 0.5);
      const double row = std::sin(2 * std::numbers::pi * y / 0.5);
      map.height(r, c) = static_cast<float>(0.03 * 0.02 * c + 0.05 * row);
      map.exg(r, c) = static_cast<float>(0.3 + 0.1 * row);
      if (with_hole && r > 50 && r < 90 && c > 50 && c < 90) {
        map.weight(r, c) = 0.0F;
        map.height(r, c) = 1e6F;  // an empty cell's value must not matter
      }
    }
  }
  return map;
}

TEST(SignalMap, TakesOutSlopesAndKeepsRows) {
  const SignalMap signal = makeSignalMap(makeRows(false), 2, {});
  EXPECT_EQ(signal.frame.rows, 100);
  EXPECT_DOUBLE_EQ(signal.frame.cell, 0.04);
  // Away from the border the height channel is the rows alone: the same as the greenness.
  for (int r = 20; r < 80; r += 7) {
    EXPECT_NEAR(signal.channel[1](r, 50), signal.channel[0](r, 50), 0.1);
  }
  EXPECT_NEAR(signal.deviation[1], 0.05 / std::sqrt(2.0), 0.01);
}

TEST(SignalMap, EmptyCellsDoNotCount) {
  const SignalMap whole = makeSignalMap(makeRows(false), 2, {});
  const SignalMap holed = makeSignalMap(makeRows(true), 2, {});
  EXPECT_EQ(holed.channel[1](35, 35), 0.0F);
  EXPECT_EQ(holed.weight(35, 35), 0.0F);
  EXPECT_NEAR(holed.channel[1](80, 80), whole.channel[1](80, 80), 0.05);
}

TEST(SignalMap, LeavesOutWhatTheTermLeavesOut) {
  SignalOptions options;
  options.term = SignalTerm::kExg;
  const SignalMap signal = makeSignalMap(makeRows(false), 1, options);
  for (const float v : signal.channel[1]) ASSERT_EQ(v, 0.0F);
  EXPECT_EQ(signal.deviation[1], 0.0);
}

TEST(SignalMap, SoilThatIsBrighterIsSeenThoughNothingIsGreener) {
  GridMap map = makeRows(false);
  std::fill(map.exg.begin(), map.exg.end(), 0.1F);
  for (int r = 0; r < 200; ++r) {
    for (int c = 0; c < 200; ++c) {
      const bool stone = (r / 10 * 7 + c / 10 * 3) % 11 == 0;
      map.colour(r, c) = stone ? Rgb{190, 180, 170} : Rgb{110, 95, 80};
    }
  }
  const SignalMap all = makeSignalMap(map, 1, {});
  EXPECT_FALSE(all.has(kGreenChannel));
  EXPECT_TRUE(all.has(kHeightChannel));
  EXPECT_TRUE(all.has(kLuminanceChannel));
  SignalOptions paper;
  paper.term = SignalTerm::kExgHeight;
  EXPECT_FALSE(makeSignalMap(map, 1, paper).has(kLuminanceChannel));
}

TEST(SignalMap, RoundingIsNoRelief) {
  GridMap map = makeRows(false);
  for (std::size_t i = 0; i < map.height.size(); ++i) {
    map.height[i] = i % 2 == 0 ? 0.0F : 2e-4F;
  }
  EXPECT_FALSE(makeSignalMap(map, 1, {}).has(kHeightChannel));
}

}  // namespace
}  // namespace agricolmap::map
