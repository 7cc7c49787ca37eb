#include "agricolmap/refine/dense_refine.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/random.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::refine {
namespace {

/// Plants as bumps at random places of a 14 × 6 m field; smooth, so that any cell can sample it.
class Field {
 public:
  explicit Field(int seed) {
    Random random(static_cast<std::uint64_t>(seed));
    for (int i = 0; i < 400; ++i) {
      plants_.push_back({random.uniform(-2, 12), random.uniform(-2, 4), random.uniform(0.5, 1)});
    }
  }
  float at(const Eigen::Vector2d& p) const {
    double sum = 0.0;
    for (const Eigen::Vector3d& plant : plants_) {
      const double d2 = (p - plant.head<2>()).squaredNorm();
      if (d2 < 0.25) sum += plant.z() * std::exp(-d2 / (2 * 0.06 * 0.06));
    }
    return static_cast<float>(sum);
  }

 private:
  std::vector<Eigen::Vector3d> plants_;
};

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
  const Field field(seed);
  const Field other(seed + 1000);
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
  double worst = 0.0;
  for (const double x : {0.0, 10.0}) {
    for (const double y : {0.0, 2.2}) {
      worst = std::max(worst, (a * Eigen::Vector2d(x, y) - b * Eigen::Vector2d(x, y)).norm());
    }
  }
  return worst;
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
    const Field field(seed);
    const Field other(seed + 1000);
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
