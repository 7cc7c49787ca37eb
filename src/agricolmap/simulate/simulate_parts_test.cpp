#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/simulate/field/drift.hpp"
#include "agricolmap/simulate/field/light.hpp"
#include "agricolmap/simulate/field/noise.hpp"

namespace agricolmap::simulate {
namespace {

TEST(Drift, IsAsLargeAsAskedForAndZeroInTheMiddle) {
  const Drift drift(10.0, 0.005, 3);
  EXPECT_LT(drift.at(5.0, 0.0).norm(), 1e-9);
  double largest = 0.0;
  for (double x = 0.0; x <= 10.0; x += 0.01) largest = std::max(largest, drift.at(x, 0.0).norm());
  EXPECT_NEAR(largest, 0.05, 1e-4);
  // Smooth: no step along the path.
  for (double x = 0.0; x < 9.99; x += 0.01) {
    EXPECT_LT((drift.at(x + 0.01, 1.0) - drift.at(x, 1.0)).norm(), 0.002);
  }
}

TEST(Noise, TilesAgreeWithPointsAndHaveUnitDeviation) {
  const NoiseTile tile(42, -3.0, 30.0, 5.0, 40.0);
  double sum2 = 0.0;
  int n = 0;
  for (double x = -3.0; x <= 30.0; x += 0.37) {
    for (double y = 5.0; y <= 40.0; y += 0.41) {
      EXPECT_NEAR(tile(x, y), noiseAt(42, x, y), 1e-4F);
      sum2 += static_cast<double>(tile(x, y) * tile(x, y));
      ++n;
    }
  }
  EXPECT_NEAR(std::sqrt(sum2 / n), 1.0, 0.2);
}

TEST(Light, SunMovesFromEastToWestAndCastsShadowsAway) {
  EXPECT_GT(sunDirection(9.0).x(), 0.3);
  EXPECT_LT(sunDirection(15.0).x(), -0.3);
  EXPECT_LT(sunDirection(12.0).y(), 0.0);
  // A wall north–south across a plane; the sun in the east shades its west side, whatever the
  // canvas's heading.
  for (const double heading : {0.0, 0.6, 1.5708, 2.5, 4.0}) {
    Canvas canvas;
    canvas.window = makeWindow({0.0, 0.0}, heading, 2.0, 2.0, 0.01);
    canvas.cells = Raster<Cell>(200, 200);
    canvas.ground = Raster<float>(200, 200);
    const Eigen::Vector2d middle = canvas.window.field({1.0, 1.0});
    const auto cellAt = [&](double east) -> Cell& {
      const Eigen::Vector2d p = canvas.window.local(middle + Eigen::Vector2d(east, 0.0)) / 0.01;
      return canvas.cells(static_cast<int>(p.y()), static_cast<int>(p.x()));
    };
    for (int r = 0; r < 200; ++r) {
      for (int c = 0; c < 200; ++c) {
        const Eigen::Vector2d p = canvas.window.field(0.01 * Eigen::Vector2d(c + 0.5, r + 0.5));
        if (std::abs(p.x() - middle.x()) < 0.03) canvas.cells(r, c).z = 0.2F;
      }
    }
    const Eigen::Vector3d sun = Eigen::Vector3d(1.0, 0.0, 1.0).normalized();
    lightCanvas(canvas, sun, 0.2);
    EXPECT_LT(cellAt(-0.10).light, 20) << heading;
    EXPECT_GT(cellAt(0.10).light, 150) << heading;
    EXPECT_GT(cellAt(-0.40).light, 150) << heading;
  }
}

}  // namespace
}  // namespace agricolmap::simulate
