#include "agricolmap/crop/fine_strips.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace agricolmap::crop {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

FieldLayers coarse() {
  FieldLayers layers;
  layers.frame = {{0.3, 0.7}, 0.04, 3, 4};
  layers.exg = Raster<float>(3, 4, 0.1F);
  layers.height = Raster<float>(3, 4, 0.2F);
  layers.above_ground = true;
  return layers;
}

TEST(Refine, PutsAStripsCellsInPlaceOfTheMaps) {
  FieldLayers layers = coarse();
  FineStrip strip{{{0.34, 0.7}, 0.01, 4, 8}, Raster<float>(4, 8, 0.5F), Raster<float>(4, 8, kNone)};
  strip.exg(1, 2) = kNone;
  strip.height(0, 0) = 0.7F;
  refine(layers, {strip});
  ASSERT_EQ(layers.exg.rows(), 12);
  ASSERT_EQ(layers.exg.cols(), 16);
  EXPECT_DOUBLE_EQ(layers.frame.cell, 0.01);
  for (int r = 0; r < 12; ++r) {
    for (int c = 0; c < 16; ++c) {
      const bool in_strip = r < 4 && c >= 4 && c < 12 && !(r == 1 && c == 6);
      EXPECT_EQ(layers.exg(r, c), in_strip ? 0.5F : 0.1F) << r << " " << c;
      EXPECT_EQ(layers.height(r, c), r == 0 && c == 4 ? 0.7F : 0.2F);
    }
  }
}

TEST(Refine, LeavesAMapWithoutStripsAsItIs) {
  FieldLayers layers = coarse();
  refine(layers, {});
  EXPECT_EQ(layers.exg.rows(), 3);
  EXPECT_DOUBLE_EQ(layers.frame.cell, 0.04);
}

}  // namespace
}  // namespace agricolmap::crop
