#include "agricolmap/refine/vertical.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/random.hpp"
#include "agricolmap/map/box_mean.hpp"

namespace agricolmap::refine {
namespace {

constexpr double kOffset = 0.37;
const Eigen::Vector2d kSlope(0.01, -0.02);

/// Rows of plants 0.75 m apart: `gap` of the way across is bare soil.
double canopyAt(const Eigen::Vector2d& p, double tall, double gap) {
  const double across = std::abs(std::remainder(p.y(), 0.75)) / 0.375;  // 0 in the row, 1 between
  if (across > 1.0 - gap) return 0.0;
  return tall * (0.6 + 0.4 * std::sin(7.0 * p.x() + 3.0 * p.y()));
}

map::GridMap emptyMap(double width, double height) {
  map::GridMap map;
  map.frame.cell = 0.02;
  map.frame.cols = static_cast<int>(std::lround(width / 0.02));
  map.frame.rows = static_cast<int>(std::lround(height / 0.02));
  map.weight = Raster<float>(map.frame.rows, map.frame.cols);
  map.height = map.weight;
  map.exg = map.weight;
  return map;
}

/// What a sensor sees that shows `seen` of the canopy's height, over the plane kOffset, kSlope when
/// `fixed`.
map::GridMap view(double tall, double gap, double seen, bool fixed, std::uint64_t seed) {
  map::GridMap map = emptyMap(6.0, 2.2);
  Random random(seed);
  for (int r = 0; r < map.frame.rows; ++r) {
    for (int c = 0; c < map.frame.cols; ++c) {
      const Eigen::Vector2d p = map.frame.centre(r, c);
      const double ground = fixed ? kOffset + kSlope.dot(p) : 0.0;
      map.weight(r, c) = 1.0F;
      map.height(r, c) =
          static_cast<float>(ground + seen * canopyAt(p, tall, gap) + random.normal(0.004));
      ++map.filled;
    }
  }
  return map;
}

double worstError(const VerticalResult& result) {
  double worst = 0.0;
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(0, 0), {6, 0}, {0, 2.2}, {6, 2.2}}) {
    const double found = result.offset + result.slope.dot(p - result.about);
    worst = std::max(worst, std::abs(found - kOffset - kSlope.dot(p)));
  }
  return worst;
}

TEST(Vertical, ACanopySeenAtHalfItsHeightDoesNotLiftTheGround) {
  for (const double tall : {0.0, 0.15, 1.5}) {
    const VerticalResult result =
        fitVertical(view(tall, 0.4, 0.5, true, 1), view(tall, 0.4, 1.0, false, 2),
                    Eigen::Affine2d::Identity(), {});
    ASSERT_EQ(result.status, VerticalStatus::kOk);
    EXPECT_LT(worstError(result), 0.005) << tall;
    EXPECT_LT(result.residual, 0.01) << tall;
    EXPECT_GT(result.ground_share, 0.2) << tall;
    if (tall > 1.0) {
      EXPECT_NEAR(result.canopy_gain, 0.5, 0.05);
    }
  }
}

TEST(Vertical, AFewGroundCellsAreEnough) {
  const VerticalResult result =
      fitVertical(view(1.0, 0.12, 0.5, true, 3), view(1.0, 0.12, 1.0, false, 4),
                  Eigen::Affine2d::Identity(), {});
  ASSERT_EQ(result.status, VerticalStatus::kOk);
  EXPECT_LT(worstError(result), 0.01);
}

TEST(Vertical, AClosedCanopyIsToldByItsGroundShare) {
  const VerticalResult open = fitVertical(
      view(1.0, 0.4, 0.5, true, 5), view(1.0, 0.4, 1.0, false, 6), Eigen::Affine2d::Identity(), {});
  const VerticalResult closed = fitVertical(
      view(1.0, 0.0, 0.5, true, 5), view(1.0, 0.0, 1.0, false, 6), Eigen::Affine2d::Identity(), {});
  EXPECT_LT(closed.ground_share, 0.5 * open.ground_share);
}

// From the side no soil is seen between the rows; what levelling found of it in few points counts.
TEST(Vertical, UnderAClosedCanopyTheLevelledPlanesCount) {
  map::GridMap fixed = view(1.0, 0.12, 0.3, true, 11);
  map::GridMap moving = view(1.0, 0.0, 1.0, false, 12);
  Random random(13);
  for (int r = 0; r < fixed.frame.rows; ++r) {
    for (int c = 0; c < fixed.frame.cols; ++c) {
      const double plane = kOffset + kSlope.dot(fixed.frame.centre(r, c));
      fixed.height(r, c) += static_cast<float>(-plane);
      moving.height(r, c) += static_cast<float>(random.uniform(0.0, 0.5));
    }
  }
  const VerticalResult unknown = fitVertical(fixed, moving, Eigen::Affine2d::Identity(), {});
  EXPECT_GT(std::abs(unknown.offset), 0.1);
  fixed.ground_deviation = moving.ground_deviation = 0.02;
  const VerticalResult known = fitVertical(fixed, moving, Eigen::Affine2d::Identity(), {});
  EXPECT_EQ(known.offset, 0.0);
  EXPECT_LT(known.residual, unknown.residual);
  EXPECT_GE(known.residual, 0.02);
}

TEST(Vertical, FewGroundCellsThatFitCountBeforeLevelledPlanes) {
  map::GridMap fixed = emptyMap(6.0, 2.2);
  map::GridMap moving = fixed;
  fixed.ground_deviation = moving.ground_deviation = 0.001;
  Random random(17);
  for (int r = 0; r < fixed.frame.rows; ++r) {
    for (int c = 0; c < fixed.frame.cols; ++c) {
      // Either sees the ground through one cell in eight, mostly not the same.
      const auto canopy = [&] { return random.chance(0.125) ? 0.0 : random.uniform(0.04, 0.2); };
      fixed.weight(r, c) = moving.weight(r, c) = 1.0F;
      fixed.height(r, c) = static_cast<float>(canopy() + random.normal(0.005));
      // Levelling took something 6 cm above the ground for it.
      moving.height(r, c) = static_cast<float>(canopy() - 0.06 + random.normal(0.005));
    }
  }
  const VerticalResult result = fitVertical(fixed, moving, Eigen::Affine2d::Identity(), {});
  EXPECT_LT(result.ground_share, 0.05);
  // Leaves beside so few gaps lift it by 2 cm; levelled planes would put it at 0.
  EXPECT_NEAR(result.offset, 0.06, 0.025);
}

TEST(Vertical, MapsThatDoNotOverlapHaveNoHeight) {
  const Eigen::Affine2d away(Eigen::Translation2d(100.0, 0.0));
  EXPECT_EQ(
      fitVertical(view(0.1, 0.4, 0.5, true, 7), view(0.1, 0.4, 1.0, false, 8), away, {}).status,
      VerticalStatus::kTooFewCells);
}

TEST(Vertical, ATiltThatLevelledMapsCannotHaveIsRefused) {
  map::GridMap fixed = view(0.1, 0.4, 0.5, true, 9);
  for (int r = 0; r < fixed.frame.rows; ++r) {
    for (int c = 0; c < fixed.frame.cols; ++c) {
      fixed.height(r, c) += static_cast<float>(0.3 * fixed.frame.centre(r, c).x());
    }
  }
  EXPECT_EQ(
      fitVertical(fixed, view(0.1, 0.4, 1.0, false, 10), Eigen::Affine2d::Identity(), {}).status,
      VerticalStatus::kTooSteep);
}

TEST(Vertical, DoubtsAHeightWhereNoGroundIsSeen) {
  // From afar a canopy without gaps has no soil, from near it has: the lowest cells are not the
  // same.
  const map::GridMap closed = view(0.8, 0.0, 1.0, true, 1);
  map::GridMap through = view(0.8, 0.0, 1.0, false, 2);
  Random random(5);
  for (std::size_t i = 0; i < through.height.size(); ++i) {
    if (random.uniform() < 0.3) through.height[i] = static_cast<float>(random.normal(0.05));
  }
  const VerticalResult hidden = fitVertical(closed, through, Eigen::Affine2d::Identity(), {});
  EXPECT_GT(hidden.deviation(), 0.5 * worstError(hidden));
  EXPECT_GT(hidden.bias(), 0.05);
  const VerticalResult clear = fitVertical(
      view(0.8, 0.4, 0.5, true, 1), view(0.8, 0.4, 1.0, false, 2), Eigen::Affine2d::Identity(), {});
  EXPECT_LT(clear.bias(), 0.01);
}

/// A drilled cereal: drills 0.14 m apart, in which plants differ, with gaps of a hand. `blur`: of
/// what is seen, in passes of a box of three cells.
map::GridMap cereal(int blur, double seen, bool fixed, std::uint64_t seed) {
  map::GridMap map = emptyMap(6.0, 2.2);
  Random plants(7);
  Raster<float> canopy(map.frame.rows, map.frame.cols);
  for (int row = 0; row < map.frame.rows; row += 7) {
    for (int c = 0; c < map.frame.cols; c += 2) {
      const auto tall = static_cast<float>(plants.chance(0.15) ? 0.0 : plants.uniform(0.1, 0.25));
      for (int r = row; r < std::min(row + 4, map.frame.rows); ++r) {
        canopy(r, c) = tall;
        if (c + 1 < map.frame.cols) canopy(r, c + 1) = tall;
      }
    }
  }
  const Raster<float> sharp = canopy;
  const Raster<float> all(map.frame.rows, map.frame.cols, 1.0F);
  const map::BoxMean around(all, 1);
  for (int pass = 0; pass < blur; ++pass) canopy = around.of(canopy);
  Random random(seed);
  for (std::size_t i = 0; i < canopy.size(); ++i) {
    map.weight[i] = 10.0F;
    map.exg[i] = sharp[i] > 0.0F ? 0.3F : 0.0F;
    map.height[i] = static_cast<float>(seen) * canopy[i] +
                    static_cast<float>((fixed ? kOffset : 0.0) + random.normal(0.003));
  }
  map.filled = canopy.size();
  return map;
}

TEST(Vertical, PlantsThatADroneBlursIntoNarrowGapsDoNotLiftTheGround) {
  for (const double seen : {1.0, 0.75}) {
    const map::GridMap robot = cereal(0, 1.0, false, 2);
    const VerticalResult sharp =
        fitVertical(cereal(0, seen, true, 1), robot, Eigen::Affine2d::Identity(), {});
    EXPECT_NEAR(sharp.offset, kOffset, 0.004);
    const VerticalResult blurred =
        fitVertical(cereal(3, seen, true, 1), robot, Eigen::Affine2d::Identity(), {});
    EXPECT_GT(blurred.lift, 0.03) << seen;  // so wrong it would be
    EXPECT_NEAR(blurred.offset, kOffset, 0.012) << seen;
    EXPECT_LT(std::abs(blurred.offset - kOffset), 2.0 * blurred.deviation());
    EXPECT_NEAR(blurred.blur, 0.02 * std::sqrt(2.0), 0.006);
    EXPECT_NEAR(blurred.canopy_gain, seen, 0.1);
    EXPECT_GT(blurred.ground_seen, 0.9);
  }
}

TEST(Vertical, LowestCellsThatAreAsGreenAsPlantsAreNoGround) {
  map::GridMap robot = cereal(0, 1.0, false, 2);
  const map::GridMap drone = cereal(3, 1.0, true, 1);
  const VerticalResult seen = fitVertical(drone, robot, Eigen::Affine2d::Identity(), {});
  // A few stones tell soil's colour; what is low elsewhere are leaves.
  Random random(3);
  for (float& green : robot.exg) green = random.chance(0.03) ? 0.0F : 0.3F;
  const VerticalResult hidden = fitVertical(drone, robot, Eigen::Affine2d::Identity(), {});
  EXPECT_LT(hidden.ground_seen, 0.2);
  EXPECT_GT(hidden.bias(), 0.1);
  EXPECT_LT(seen.bias(), 0.03);
}

TEST(Vertical, AWheelTrackAloneDoesNotTilt) {
  // Ground along one line tells nothing of the slope across it; the surface does.
  map::GridMap fixed = emptyMap(6.0, 2.2), moving = fixed;
  Random random(4);
  for (int r = 0; r < fixed.frame.rows; ++r) {
    for (int c = 0; c < fixed.frame.cols; ++c) {
      const Eigen::Vector2d p = fixed.frame.centre(r, c);
      const bool track = std::abs(p.y() - 0.6) < 0.12;
      const double tall = track ? 0.0 : 0.3 + 0.1 * std::sin(9.0 * p.x()) * std::sin(11.0 * p.y());
      fixed.weight(r, c) = moving.weight(r, c) = 10.0F;
      moving.height(r, c) = static_cast<float>(tall + random.normal(0.006));
      // Ruts are not level: their sides fool a fit that knows nothing else.
      const double rut = track ? 0.25 * (p.y() - 0.6) : 0.0;
      fixed.height(r, c) =
          static_cast<float>(kOffset + kSlope.dot(p) + 0.8 * tall + rut + random.normal(0.006));
    }
  }
  const VerticalResult result = fitVertical(fixed, moving, Eigen::Affine2d::Identity(), {});
  EXPECT_NEAR(result.slope.y(), kSlope.y(), 0.06);
  const double middle = result.offset + result.slope.dot(Eigen::Vector2d(3.0, 1.1) - result.about);
  EXPECT_NEAR(middle, kOffset + kSlope.dot(Eigen::Vector2d(3.0, 1.1)), 0.03);
}

TEST(Vertical, FlatMapsHaveNoRelief) {
  map::GridMap flat = view(0.3, 0.4, 1.0, true, 1);
  for (float& height : flat.height) height = 0.0F;
  EXPECT_FALSE(
      fitVertical(flat, view(0.3, 0.4, 1.0, false, 2), Eigen::Affine2d::Identity(), {}).relief);
}

// Hills that are a fifth too low in the moving map, under rows of plants that the drone sees at
// 0.8 of their height: the ground tells the scale, not the plants.
TEST(Vertical, AScaleThatTheGroundTellsIsFollowed) {
  map::GridMap fixed = view(0.3, 0.4, 0.8, true, 1);
  map::GridMap moving = view(0.3 / 1.2, 0.4, 1.0, false, 2);
  for (int r = 0; r < fixed.frame.rows; ++r) {
    for (int c = 0; c < fixed.frame.cols; ++c) {
      const Eigen::Vector2d p = fixed.frame.centre(r, c);
      const double hill = 0.1 * std::sin(1.2 * p.x() + 0.3 * p.y());
      fixed.height(r, c) += static_cast<float>(hill);
      moving.height(r, c) += static_cast<float>(hill / 1.2);
    }
  }
  const VerticalResult result = fitVertical(fixed, moving, Eigen::Affine2d::Identity(), {});
  ASSERT_EQ(result.status, VerticalStatus::kOk);
  EXPECT_TRUE(result.measured_scale.measured());
  EXPECT_NEAR(result.scale, 1.2, 0.03);
  EXPECT_LT(worstError(result), 0.01);
  const Eigen::Affine3d lifted = liftPose(Eigen::Affine2d::Identity(), result);
  EXPECT_EQ(lifted.linear()(2, 2), result.scale);

  VerticalOptions assumed;
  assumed.scale = VerticalScaleKind::kAssumed;
  const VerticalResult as_it_is = fitVertical(fixed, moving, Eigen::Affine2d::Identity(), assumed);
  EXPECT_EQ(as_it_is.scale, 1.0);
  EXPECT_FALSE(as_it_is.measured_scale.measured());
  EXPECT_GT(as_it_is.residual, 2.0 * result.residual);
}

}  // namespace
}  // namespace agricolmap::refine
