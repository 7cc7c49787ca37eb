#include "agricolmap/map/vegetation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::map {
namespace {

/// A map of cells whose Excess Green is `greenness(row, col)`; where that is NaN the cell is empty.
template <typename Greenness>
GridMap makeMap(int rows, int cols, const Greenness& greenness) {
  GridMap map;
  map.frame = {Eigen::Vector2d(1.0, -2.0), 0.02, rows, cols};
  map.weight = Raster<float>(rows, cols);
  map.height = Raster<float>(rows, cols, 0.1F);
  map.exg = Raster<float>(rows, cols);
  for (int row = 0; row < rows; ++row) {
    for (int col = 0; col < cols; ++col) {
      const double value = greenness(row, col);
      if (std::isnan(value)) continue;
      map.weight(row, col) = 1.0F;
      map.exg(row, col) = static_cast<float>(value);
      ++map.filled;
    }
  }
  return map;
}

/// Soil and plants with their own means and deviations; `cover` of the cells are plants.
GridMap mixedMap(double cover, double soil, double green, double deviation, std::uint64_t seed) {
  Random random(seed);
  return makeMap(300, 300, [&](int, int) {
    const bool plant = random.chance(cover);
    return (plant ? green : soil) + random.normal(plant ? 2.0 * deviation : deviation);
  });
}

TEST(Vegetation, FindsTheThresholdOfEachCamera) {
  // The same field through cameras of different gain and offset: a constant would serve none.
  for (const double gain : {0.3, 1.0, 3.0}) {
    for (const double offset : {-0.2, 0.0, 0.3}) {
      for (const double cover : {0.01, 0.02, 0.1, 0.5, 0.9}) {
        const GridMap map = mixedMap(cover, offset, offset + gain * 0.4, gain * 0.04, 7);
        const VegetationThreshold found = vegetationThreshold(map, {});
        ASSERT_EQ(found.status, VegetationStatus::kOk) << gain << ' ' << offset << ' ' << cover;
        EXPECT_NEAR(found.share, cover, 0.02 * cover + 0.005);
        EXPECT_NEAR((found.threshold - offset) / gain, 0.2, 0.03);
      }
    }
  }
}

TEST(Vegetation, OnePopulationIsAStatus) {
  Random random(1);
  const auto status = [&](double mean) {
    return vegetationThreshold(
               makeMap(200, 200, [&](int, int) { return mean + random.normal(0.05); }), {})
        .status;
  };
  EXPECT_EQ(status(0.0), VegetationStatus::kNoVegetation);
  EXPECT_EQ(status(0.4), VegetationStatus::kClosedCanopy);
  EXPECT_EQ(vegetationThreshold(makeMap(50, 50, [](int, int) { return 0.0; }), {}).status,
            VegetationStatus::kConstant);
  EXPECT_EQ(vegetationThreshold(makeMap(50, 50, [](int, int) { return std::nan(""); }), {}).status,
            VegetationStatus::kTooFewCells);
}

TEST(Vegetation, AClosedCanopyGivesItsGreenerHalf) {
  Random random(1);
  const auto extract = [&](double mean) {
    return extractVegetation(
        makeMap(200, 200, [&](int, int) { return mean + random.normal(0.05); }), {});
  };
  const Vegetation canopy = extract(0.4);
  EXPECT_EQ(canopy.threshold.status, VegetationStatus::kClosedCanopy);
  EXPECT_NEAR(static_cast<double>(canopy.points.size()), 20000.0, 2000.0);
  EXPECT_TRUE(extract(0.0).points.empty());
}

TEST(Vegetation, AHandfulOfGreenCellsIsNoVegetation) {
  Random random(1);
  const GridMap map = makeMap(200, 200, [&](int row, int col) {
    return (row == 50 && col < 60 ? 0.4 : 0.0) + random.normal(0.02);
  });
  EXPECT_NE(vegetationThreshold(map, {}).status, VegetationStatus::kOk);
}

TEST(Vegetation, PointsLieAtTheCentresOfGreenCells) {
  const GridMap map = makeMap(40, 40, [](int row, int col) {
    if (row == 3) return std::nan("");
    return (row >= 10 && row < 14 && col >= 20 && col < 30 ? 0.4 : 0.0) +
           0.01 * ((row * 7 + col * 3) % 5);
  });
  const Vegetation vegetation = extractVegetation(map, {});
  ASSERT_EQ(vegetation.threshold.status, VegetationStatus::kOk);
  ASSERT_EQ(vegetation.points.size(), 40U);
  EXPECT_EQ(vegetation.mask(10, 20), 1);
  EXPECT_EQ(vegetation.mask(9, 20), 0);
  EXPECT_NEAR(vegetation.points[0].position.x(), 1.0 + 20.5 * 0.02, 1e-12);
  EXPECT_NEAR(vegetation.points[0].position.y(), -2.0 + 10.5 * 0.02, 1e-12);
  EXPECT_NEAR(vegetation.points[0].height, 0.1, 1e-6);
  for (const VegetationPoint& p : vegetation.points) {
    EXPECT_GT(p.weight, 0.5);
    EXPECT_LE(p.weight, 1.0);
  }
}

TEST(Vegetation, MarginsAreDistancesToUnseenGround) {
  // Seen: columns 0–199, but for the lower left quarter and single cells that chance left empty.
  Random random(4);
  const GridMap map = makeMap(200, 240, [&](int row, int col) {
    if (col >= 200 || (row < 100 && col < 100) || random.chance(0.1)) return std::nan("");
    return (random.chance(0.3) ? 0.4 : 0.0) + random.normal(0.02);
  });
  const Vegetation vegetation = extractVegetation(map, {});
  ASSERT_FALSE(vegetation.points.empty());
  for (const VegetationPoint& p : vegetation.points) {
    const double x = p.position.x() - 1.0;
    const double y = p.position.y() + 2.0;
    const double corner = std::hypot(std::max(0.0, x - 2.0), std::max(0.0, y - 2.0));
    const double outer = std::min({4.0 - x, 4.0 - y, x, y});
    EXPECT_NEAR(p.margin, std::min(outer, corner), 0.06 + 0.1 * p.margin) << x << ' ' << y;
  }
}

TEST(Vegetation, ThinningKeepsWeightAndCentroid) {
  Random random(3);
  std::vector<VegetationPoint> points(20000);
  for (VegetationPoint& p : points) {
    p = {{random.uniform(-3.0, 3.0), random.uniform(-1.0, 9.0)}, random.normal(), random.uniform()};
  }
  const auto sums = [](const std::vector<VegetationPoint>& cloud) {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (const VegetationPoint& p : cloud) {
      sum += p.weight * Eigen::Vector4d(p.position.x(), p.position.y(), p.height, 1.0);
    }
    return sum;
  };
  const Eigen::Vector4d before = sums(points);
  for (const std::size_t count : {4U, 50U, 1000U, 7000U, 19999U}) {
    const std::vector<VegetationPoint> thinned = thinToAtMost(points, count);
    EXPECT_LE(thinned.size(), count);
    EXPECT_GE(thinned.size(), count / 2);
    EXPECT_LT((sums(thinned) - before).norm(), 1e-8);
  }
  EXPECT_EQ(thinToAtMost(points, 20000).size(), points.size());
  EXPECT_THROW(thinVegetation(points, 0.0), UsageError);
  EXPECT_TRUE(thinVegetation({}, 0.1).empty());
}

TEST(Vegetation, ThinsLinesAndHeapsToo) {
  std::vector<VegetationPoint> points(1000);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = {{0.01 * static_cast<double>(i), 5.0}, 0.0, 1.0};
  }
  EXPECT_LE(thinToAtMost(points, 100).size(), 100U);
  EXPECT_GE(thinToAtMost(points, 100).size(), 50U);
  for (VegetationPoint& p : points) p.position = {2.0, 2.0};
  EXPECT_EQ(thinToAtMost(points, 100).size(), 1U);
}

}  // namespace
}  // namespace agricolmap::map
