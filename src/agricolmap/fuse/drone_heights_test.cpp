#include "agricolmap/fuse/drone_heights.hpp"

#include <gtest/gtest.h>

#include "agricolmap/fuse/chamfer.hpp"

namespace agricolmap::fuse {
namespace {

constexpr int kCells = 200;
constexpr double kCell = 0.02;

map::GridMap flatMap(float height) {
  map::GridMap map;
  map.frame = {Eigen::Vector2d::Zero(), kCell, kCells, kCells};
  map.height = Raster<float>(kCells, kCells, height);
  map.colour = Raster<Rgb>(kCells, kCells, Rgb{60, 140, 50});
  map.weight = Raster<float>(kCells, kCells, 10.0F);
  return map;
}

// Rows of leaves 0.3 m high, seen as high from the air as from the side, with their shadows beside
// them; what lies further from a shadow is bare soil, where the drone saw a leaf that had bent.
TEST(HeightBias, IsNotThatOfCellsFarFromShadows) {
  const map::GridMap drone = flatMap(0.3F);
  const Raster<float> ground(kCells, kCells, 0.0F), cover(kCells, kCells, 1.0F);
  StripCells strip;
  strip.coarse = flatMap(0.3F);
  Raster<std::uint8_t> hidden(kCells, kCells, 0);
  int low = 0, seen = 0;
  for (int row = 0; row < kCells; ++row) {
    for (int col = 0; col < kCells; ++col) {
      const int across = col % 10;
      hidden(row, col) = across == 0 ? 1 : 0;
      if (across == 5) strip.coarse.height(row, col) = 0.0F;
      low += across == 5 ? 1 : 0;
      seen += across == 0 ? 0 : 1;
    }
  }
  strip.depth = chamferDistance(hidden, kCell, 0.0F);
  const auto bias = heightBiasOf({drone, ground, cover}, {&strip});
  ASSERT_TRUE(bias.has_value());
  EXPECT_EQ(bias->cells, static_cast<std::size_t>(seen));
  const double share = (static_cast<double>(low) / seen - 0.05) / 0.9;  // a twentieth is cut off
  EXPECT_NEAR(bias->curves[1].shiftAt(0.3), -0.3 * share, 0.003);
}

}  // namespace
}  // namespace agricolmap::fuse
