#include "agricolmap/map/grid_map.hpp"

#include <gtest/gtest.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::map {
namespace {

Box2 box(double x0, double y0, double x1, double y1) {
  return {Eigen::Vector2d(x0, y0), Eigen::Vector2d(x1, y1)};
}

Cloud randomCloud(std::size_t count) {
  Random random(3);
  Cloud cloud;
  cloud.name = "random";
  for (std::size_t i = 0; i < count; ++i) {
    cloud.xyz.emplace_back(static_cast<float>(random.uniform(0, 3)),
                           static_cast<float>(random.uniform(0, 2)),
                           static_cast<float>(random.uniform(0, 0.1)));
    cloud.rgb.push_back({static_cast<std::uint8_t>(random.below(256)),
                         static_cast<std::uint8_t>(random.below(256)),
                         static_cast<std::uint8_t>(random.below(256))});
  }
  return cloud;
}

TEST(ExcessGreen, FollowsThePaperAndIgnoresBrightnessWhenChromatic) {
  EXPECT_FLOAT_EQ(excessGreen({10, 60, 20}, ExgKind::kPlain), 90.0F / 255.0F);
  EXPECT_FLOAT_EQ(excessGreen({10, 60, 20}, ExgKind::kChromatic),
                  excessGreen({20, 120, 40}, ExgKind::kChromatic));
  EXPECT_EQ(excessGreen({0, 0, 0}, ExgKind::kChromatic), 0.0F);
}

TEST(GridMap, WeighsPointsByTheirDistanceToTheCellCentre) {
  Cloud cloud;
  cloud.name = "two";
  cloud.xyz = {{0.011F, 0.01F, 1.0F}, {0.019F, 0.01F, 3.0F}};
  cloud.rgb = {{0, 255, 0}, {255, 0, 0}};
  GridOptions options;
  options.sigma = 0.01;
  options.exg = ExgKind::kPlain;
  const GridMap map =
      makeGridMap(cloud, Eigen::Affine3d::Identity(), box(0, 0, 0.04, 0.04), options);
  ASSERT_EQ(map.frame.rows, 2);
  ASSERT_EQ(map.filled, 1U);
  EXPECT_FALSE(map.valid(1, 1));
  const double near = std::exp(-0.5 * 0.001 * 0.001 / 1e-4);
  const double far = std::exp(-0.5 * 0.009 * 0.009 / 1e-4);
  EXPECT_NEAR(map.height(0, 0), (near * 1 + far * 3) / (near + far), 1e-4);
  EXPECT_NEAR(map.exg(0, 0), (near * 2 - far) / (near + far), 1e-4);
  EXPECT_EQ(map.weight(0, 0), 2.0F);
}

// With a narrow Gaussian the weights of points far from the centre are no floats any more.
TEST(GridMap, HoldsNumbersForAnyOptionsWithinTheirLimits) {
  const Cloud cloud = randomCloud(20000);
  for (const auto& [cell, sigma] : {std::pair{0.02, 0.0001}, {0.02, 0.001}, {1.0, 0.04}}) {
    const GridMap map = makeGridMap(cloud, Eigen::Affine3d::Identity(), box(0, 0, 3, 2),
                                    {.cell = cell, .sigma = sigma});
    std::size_t filled = 0;
    for (std::size_t i = 0; i < map.height.size(); ++i) {
      if (!map.valid(i)) continue;
      ++filled;
      // Heights are from 0 to 0.1 m.
      ASSERT_TRUE(map.height[i] >= -1e-6F && map.height[i] <= 0.1001F)
          << map.height[i] << " for sigma " << sigma;
      ASSERT_TRUE(std::abs(map.exg[i]) <= 2.0F) << map.exg[i] << " for sigma " << sigma;
    }
    EXPECT_EQ(filled, map.filled);
    // 1.3 points a small cell, and every cell that holds one has a height.
    EXPECT_GT(filled, cell < 0.1 ? 10000U : 5U);
  }
}

TEST(GridMap, CountsWhatFallsInside) {
  const Cloud cloud = randomCloud(20000);
  const GridMap map = makeGridMap(cloud, Eigen::Affine3d::Identity(), box(1, 0, 2, 2), {});
  EXPECT_NEAR(static_cast<double>(map.points), 20000.0 / 3.0, 300);
  EXPECT_THROW(makeGridMap(cloud, Eigen::Affine3d::Identity(), box(10, 10, 11, 11), {}),
               InputError);
}

TEST(GridMap, RefusesMapsThatTakeTooMuchMemoryAndNamesTheRemedy) {
  const Cloud cloud = randomCloud(10);
  for (const double side : {380.0, 1e6, 1e30}) {
    try {
      makeGridMap(cloud, Eigen::Affine3d::Identity(), box(0, 0, side, side), {});
      FAIL() << side;
    } catch (const InputError& error) {
      const std::string what = error.what();
      EXPECT_NE(what.find("limit 4 GiB"), std::string::npos) << what;
      EXPECT_NE(what.find("grid.cell"), std::string::npos) << what;
    }
  }
}

TEST(GridMap, BoxesThatLieApartHaveNoWindow) {
  // Coarse cells, of which one beside both boxes would catch points.
  GridOptions options;
  options.cell = 1.0;
  const Box2 window = box(0, 0, 3, 2).intersection(box(3.2, 0, 6, 2));
  try {
    makeGridMap(randomCloud(1000), Eigen::Affine3d::Identity(), window, options);
    ADD_FAILURE() << "a map of nothing";
  } catch (const InputError& error) {
    EXPECT_EQ(error.remedy(), Remedy::kInitialGuess);
  }
}

TEST(GridMap, IsTheSameOnOneThread) {
  const Cloud cloud = randomCloud(200000);
  const Box2 window = box(0, 0, 3, 2);
  const GridMap many = makeGridMap(cloud, Eigen::Affine3d::Identity(), window, {});
  const ThreadLimit limit(1);
  const GridMap one = makeGridMap(cloud, Eigen::Affine3d::Identity(), window, {});
  EXPECT_TRUE(std::equal(many.height.begin(), many.height.end(), one.height.begin()));
  EXPECT_TRUE(std::equal(many.exg.begin(), many.exg.end(), one.exg.begin()));
  EXPECT_TRUE(std::equal(many.colour.begin(), many.colour.end(), one.colour.begin()));
}

TEST(GridMap, CroppedIsTheSameInItsWindow) {
  const GridMap map =
      makeGridMap(randomCloud(50000), Eigen::Affine3d::Identity(), box(0, 0, 3, 2), {});
  const GridMap part = croppedMap(map, box(0.71, 0.5, 1.3, 5.0));
  ASSERT_GT(part.frame.rows, 70);
  ASSERT_LT(part.frame.cols, 35);
  for (int r = 0; r < part.frame.rows; ++r) {
    for (int c = 0; c < part.frame.cols; ++c) {
      const Eigen::Vector2d there = map.frame.cellOf(part.frame.centre(r, c));
      const int row = static_cast<int>(std::lround(there.y()));
      const int col = static_cast<int>(std::lround(there.x()));
      ASSERT_EQ(part.height(r, c), map.height(row, col));
      ASSERT_EQ(part.colour(r, c), map.colour(row, col));
    }
  }
  EXPECT_EQ(croppedMap(map, box(10, 10, 11, 11)).weight.size(), 0U);
}

TEST(GridMap, CellsFollowTheSpacingOfThePoints) {
  const GridOptions coarse = coarsened({}, 0.05);
  EXPECT_NEAR(coarse.cell, 0.035, 1e-12);
  EXPECT_NEAR(coarse.sigma, 2.0 * coarse.cell, 1e-12);
  EXPECT_EQ(coarsened({}, 0.01).cell, GridOptions{}.cell);
  EXPECT_EQ(coarsened({.coarsen = false}, 0.05).cell, GridOptions{}.cell);
}

}  // namespace
}  // namespace agricolmap::map
