#include "agricolmap/change/common_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace agricolmap::change {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

/// 2 x + 3 y at the middles of the cells.
Raster<float> plane(const GridFrame& frame) {
  Raster<float> values(frame.rows, frame.cols);
  for (int r = 0; r < frame.rows; ++r) {
    for (int c = 0; c < frame.cols; ++c) {
      values(r, c) = static_cast<float>(Eigen::Vector2d(2.0, 3.0).dot(frame.centre(r, c)));
    }
  }
  return values;
}

void expectPlane(const Raster<float>& values, const GridFrame& frame, double tolerance) {
  const Raster<float> truth = plane(frame);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(values[i], truth[i], tolerance);
}

TEST(CommonGrid, IsTheCoarserMapsWhereBothAre) {
  const GridFrame fine{{10.0, 20.0}, 0.05, 200, 300};
  const GridFrame coarse{{9.98, 19.93}, 0.12, 60, 500};
  for (const GridFrame& common : {*commonGrid(fine, coarse), *commonGrid(coarse, fine)}) {
    EXPECT_DOUBLE_EQ(common.cell, 0.12);
    EXPECT_NEAR(common.corner.x(), 9.98 + 0.12, 1e-9);
    EXPECT_NEAR(common.corner.y(), 19.93 + 0.12, 1e-9);
    EXPECT_EQ(common.cols, 124);
    EXPECT_EQ(common.rows, 59);
  }
  EXPECT_TRUE(sameGrid(*commonGrid(fine, fine), fine));
  GridFrame rounded = fine;
  rounded.corner.x() += 1e-9;
  EXPECT_TRUE(sameGrid(*commonGrid(fine, rounded), fine));
}

TEST(CommonGrid, NeedsAnOverlap) {
  const GridFrame one{{0.0, 0.0}, 0.1, 10, 10};
  const GridFrame beside{{0.95, 0.0}, 0.1, 10, 10};
  EXPECT_FALSE(commonGrid(one, beside).has_value());
}

TEST(AreaMean, KeepsAPlane) {
  const GridFrame from{{0.0, 0.0}, 0.05, 80, 90};
  // Exactly where sides are whole multiples; else a cell cut in two counts as level in both parts,
  // which is worth an eighth of the finer cell squared over the coarser at most, on either side.
  for (const double cell : {0.05, 0.1, 0.15, 0.07, 0.333}) {
    const bool whole = std::abs(std::remainder(cell, from.cell)) < 1e-9;
    const GridFrame to = *commonGrid(from, {{0.013, 0.031}, cell, 10, 9});
    const double cut = (2.0 + 3.0) * 2.0 * from.cell * from.cell / (8.0 * cell);
    expectPlane(areaMean(plane(from), from, to), to, whole ? 1e-5 : cut);
  }
}

TEST(AreaMean, LeavesOutWhatIsMostlyUnknown) {
  const GridFrame from{{0.0, 0.0}, 1.0, 4, 4};
  const GridFrame to{{0.0, 0.0}, 2.0, 2, 2};
  Raster<float> values(4, 4, 1.0F);
  values(0, 0) = kNone;
  values(0, 1) = 5.0F;
  values(2, 2) = values(2, 3) = values(3, 3) = kNone;
  const Raster<float> means = areaMean(values, from, to);
  EXPECT_FLOAT_EQ(means(0, 0), 7.0F / 3.0F);
  EXPECT_TRUE(std::isnan(means(1, 1)));
  EXPECT_FLOAT_EQ(means(0, 1), 1.0F);
}

TEST(AreaRms, MakesNoErrorSmaller) {
  const GridFrame from{{0.0, 0.0}, 1.0, 4, 4};
  const GridFrame to{{0.0, 0.0}, 4.0, 1, 1};
  EXPECT_FLOAT_EQ(areaRms(Raster<float>(4, 4, 0.03F), from, to)(0, 0), 0.03F);
}

TEST(NearestCode, IsTheCodeAtTheMiddle) {
  const GridFrame from{{0.0, 0.0}, 1.0, 2, 4};
  Raster<std::uint16_t> codes(2, 4, 1);
  codes(1, 3) = 9;
  const GridFrame to{{1.4, 0.4}, 1.5, 1, 1};
  EXPECT_EQ(nearestCode(codes, from, to)(0, 0), 1);
  EXPECT_EQ(nearestCode(codes, from, {{2.5, 0.5}, 1.5, 1, 1})(0, 0), 9);
}

}  // namespace
}  // namespace agricolmap::change
