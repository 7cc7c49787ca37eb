#include "agricolmap/refine/dense_refine.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/pose_distance.hpp"
#include "agricolmap/map/test_field.hpp"

namespace agricolmap::refine {
namespace {

/// Plants at random places of a 14 × 6 m field, the same for a seed.
testing::BumpField plants(int seed) {
  return {static_cast<std::uint64_t>(seed), 400,
          map::Box2(Eigen::Vector2d(-2.0, -2.0), Eigen::Vector2d(12.0, 4.0)), 0.06, 0.06};
}

map::SignalMap sample(const GridFrame& frame,
                      const std::function<float(const Eigen::Vector2d&)>& f) {
  map::GridMap map;
  map.frame = frame;
  map.weight = Raster<float>(frame.rows, frame.cols, 1.0F);
  map.height = Raster<float>(frame.rows, frame.cols);
  map.exg = Raster<float>(frame.rows, frame.cols);
  map.colour = Raster<Rgb>(frame.rows, frame.cols);
  for (int r = 0; r < frame.rows; ++r) {
    for (int c = 0; c < frame.cols; ++c) {
      map.exg(r, c) = map.height(r, c) = f(frame.centre(r, c));
    }
  }
  return map::makeSignalMap(map, 1, {});
}

struct Case {
  map::SignalMap fixed;
  map::SignalMap moving;
  Eigen::Affine2d truth;
};

/// The moving map shows truth⁻¹ of the field, with noise of its own where `other` says so.
Case makeCase(int seed, double unshared) {
  const testing::BumpField field = plants(seed);
  const testing::BumpField other = plants(seed + 1000);
  Case c;
  c.truth = Eigen::Translation2d(0.3, -0.2) * Eigen::Rotation2Dd(0.05);
  c.truth.linear() *= Eigen::Vector2d(1.04, 0.97).asDiagonal();
  c.fixed = sample({{-2, -2}, 0.05, 120, 280}, [&](const auto& p) { return field.at(p); });
  c.moving = sample({{0, 0}, 0.05, 44, 200}, [&](const auto& p) {
    return field.at(c.truth * p) + static_cast<float>(unshared) * other.at(p);
  });
  return c;
}

double worstCorner(const Eigen::Affine2d& a, const Eigen::Affine2d& b) {
  return poseDistance(cornersOf({Eigen::Vector2d(0.0, 0.0), Eigen::Vector2d(10.0, 2.2)}), a, b);
}

TEST(DenseRefine, FindsTheAffineFromACellAway) {
  for (int seed = 1; seed <= 5; ++seed) {
    const Case c = makeCase(seed, 0.0);
    const Eigen::Affine2d start = Eigen::Translation2d(0.05, -0.04) * c.truth;
    const DenseRefineResult result = refineDense(c.fixed, c.moving, start, {});
    ASSERT_EQ(result.status, RefineStatus::kConverged);
    EXPECT_LT(worstCorner(result.fixed_from_moving, c.truth), 0.006) << "seed " << seed;
    EXPECT_GT(result.overlap, 0.95);
  }
}

TEST(DenseRefine, ImprovesThoughHalfOfThePlantsDiffer) {
  for (int seed = 1; seed <= 5; ++seed) {
    const Case c = makeCase(seed, 0.7);
    const Eigen::Affine2d start = Eigen::Translation2d(0.04, 0.05) * c.truth;
    const DenseRefineResult result = refineDense(c.fixed, c.moving, start, {});
    ASSERT_EQ(result.status, RefineStatus::kConverged);
    EXPECT_LT(worstCorner(result.fixed_from_moving, c.truth), 0.03) << "seed " << seed;
  }
}

TEST(DenseRefine, IsNotDrawnToWhereTheFixedMapIsCalm) {
  // Plants grow larger across the strip, and most of what the moving map shows is its own.
  for (int seed = 1; seed <= 5; ++seed) {
    const testing::BumpField field = plants(seed);
    const testing::BumpField other = plants(seed + 1000);
    const auto grown = [&](const Eigen::Vector2d& p) {
      return static_cast<float>(std::clamp(1.0 + 0.5 * p.y(), 0.2, 3.0)) * field.at(p);
    };
    Case c = makeCase(seed, 0.0);
    c.fixed = sample({{-2, -2}, 0.05, 120, 280}, grown);
    c.moving = sample({{0, 0}, 0.05, 44, 200},
                      [&](const auto& p) { return grown(c.truth * p) + 2.0F * other.at(p); });
    const DenseRefineResult result = refineDense(c.fixed, c.moving, c.truth, {});
    ASSERT_EQ(result.status, RefineStatus::kConverged);
    EXPECT_LT(worstCorner(result.fixed_from_moving, c.truth), 0.015) << "seed " << seed;
  }
}

TEST(DenseRefine, SaysSoWhenThereIsNothingInCommon) {
  const Case c = makeCase(1, 0.0);
  const Eigen::Affine2d away = Eigen::Translation2d(100, 0) * c.truth;
  EXPECT_EQ(refineDense(c.fixed, c.moving, away, {}).status, RefineStatus::kNoOverlap);
}

TEST(DenseRefine, IsTheSameOnOneThread) {
  const Case c = makeCase(2, 0.3);
  const DenseRefineResult many = refineDense(c.fixed, c.moving, c.truth, {});
  const ThreadLimit limit(1);
  const DenseRefineResult one = refineDense(c.fixed, c.moving, c.truth, {});
  EXPECT_EQ(many.fixed_from_moving.matrix(), one.fixed_from_moving.matrix());
}

}  // namespace
}  // namespace agricolmap::refine
