#include "agricolmap/core/bilinear.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "agricolmap/core/raster.hpp"

namespace agricolmap {
namespace {

/// What bilinear reading gets exactly.
double surface(double col, double row) { return 3.0 + 2.0 * col - row + 0.5 * col * row; }

Raster<double> sampled(int rows, int cols) {
  Raster<double> raster(rows, cols);
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < cols; ++c) raster(r, c) = surface(c, r);
  }
  return raster;
}

TEST(Bilinear, IsExactForWhatIsBilinear) {
  const Raster<double> raster = sampled(4, 5);
  for (const double col : {0.0, 0.3, 1.0, 2.75, 3.999}) {
    for (const double row : {0.0, 0.6, 2.0, 2.5}) {
      const auto cells = cellsWithin<double>(4, 5, col, row);
      ASSERT_TRUE(cells) << col << ", " << row;
      EXPECT_NEAR(cells->mean(raster), surface(col, row), 1e-12);
      const auto [ll, lr, ul, ur] = cells->shares();
      EXPECT_NEAR(ll * raster(cells->row, cells->col) + lr * raster(cells->row, cells->col + 1) +
                      ul * raster(cells->row + 1, cells->col) +
                      ur * raster(cells->row + 1, cells->col + 1),
                  surface(col, row), 1e-12);
      EXPECT_NEAR(cellsClamped<double>(4, 5, col, row).mean(raster), surface(col, row), 1e-12);
    }
  }
}

TEST(Bilinear, NothingIsReadBesideTheRaster) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [col, row] : {std::pair{-0.1, 1.0},
                                 {1.0, -0.1},
                                 {4.0, 1.0},
                                 {1.0, 3.0},
                                 {1e300, 1.0},
                                 {-1e300, 1.0},
                                 {kNan, 1.0},
                                 {1.0, kNan}}) {
    EXPECT_FALSE(cellsWithin<float>(4, 5, col, row)) << col << ", " << row;
  }
  EXPECT_FALSE(cellsWithin<double>(0, 0, 0.0, 0.0));
  EXPECT_FALSE(cellsWithin<double>(1, 9, 2.0, 0.0)) << "one row has nothing between its cells";
}

TEST(Bilinear, ClampedItIsAsAtTheBorder) {
  const Raster<double> raster = sampled(4, 5);
  EXPECT_EQ(cellsClamped<double>(4, 5, -7.0, 1.5).mean(raster), surface(0.0, 1.5));
  EXPECT_EQ(cellsClamped<double>(4, 5, 1.5, 1e9).mean(raster), surface(1.5, 3.0));
  EXPECT_EQ(cellsClamped<double>(4, 5, 4.0, 3.0).mean(raster), surface(4.0, 3.0));
  const Raster<double> row = sampled(1, 5), cell = sampled(1, 1);
  EXPECT_EQ(cellsClamped<double>(1, 5, 2.5, 0.7).mean(row), surface(2.5, 0.0));
  EXPECT_EQ(cellsClamped<double>(1, 1, 2.5, 0.7).mean(cell), surface(0.0, 0.0));
}

TEST(Bilinear, AroundAPlaceBesideTheRasterLieCellsThatDoNotExist) {
  const auto cells = cellsAround<float>(-0.25, 7.5);
  EXPECT_EQ(cells.col, -1);
  EXPECT_EQ(cells.row, 7);
  EXPECT_FLOAT_EQ(cells.u, 0.75F);
  EXPECT_FLOAT_EQ(cells.v, 0.5F);
}

}  // namespace
}  // namespace agricolmap
