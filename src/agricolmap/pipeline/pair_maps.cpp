#include "agricolmap/pipeline/pair_maps.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::pipeline {
namespace {

// Beyond this ratio of areas "moving" and "fixed" were swapped, or one is in other units.
constexpr double kMaxAreaRatio = 4.0;
/// A long strip's direction is told by so many points; it is one from so many widths on, and as far
/// as the guess knows its heading [°].
constexpr std::size_t kSamples = 20'000;
constexpr double kLeastLength = 4.0;
constexpr double kMostHeading = 45.0;

struct PointSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  PointSum& operator+=(const PointSum& other) {
    sum += other.sum;
    return *this;
  }
};

/// In double and about the origins, so that UTM coordinates cancel before anything is float.
Eigen::Affine3d localGuess(const CloudFacts& fixed, const Cloud& moving,
                           const Eigen::Affine3d& guess) {
  return Eigen::Affine3d(Eigen::Translation3d(-fixed.origin) * guess *
                         Eigen::Translation3d(moving.origin));
}

Eigen::AngleAxisd turned(double turn) { return {turn, Eigen::Vector3d::UnitZ()}; }

}  // namespace

Eigen::Vector3d meanOf(const PointStream& cloud) {
  const CloudFacts& facts = cloud.facts();
  if (facts.points == 0) return facts.origin;
  PointSum total;
  cloud.pass([&](const PointBatch& batch) {
    // Goes on where the batch before ended: one sum of all chunks, in their order.
    total = parallelSum<PointSum>(batch.size(), 1U << 16, total,
                                  [&](std::size_t begin, std::size_t end) {
                                    PointSum part;
                                    for (std::size_t i = begin; i < end; ++i) {
                                      part.sum += batch.xyz[i].cast<double>();
                                    }
                                    return part;
                                  });
  });
  return facts.origin + total.sum / static_cast<double>(facts.points);
}

Eigen::Vector3d meanOf(const Cloud& cloud) { return meanOf(CloudStream(cloud)); }

Eigen::Affine3d centredGuess(const FixedCloud& fixed, const Cloud& moving,
                             const Eigen::Affine3d& guess, const PriorUncertainty& uncertainty) {
  if (!uncertainty.anywhere()) return guess;
  return Eigen::Translation3d(fixed.mean() - guess * meanOf(moving)) * guess;
}

double turnAlong(const CloudFacts& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const PriorUncertainty& uncertainty, double from) {
  if (moving.xyz.empty() || uncertainty.anywhere() || uncertainty.heading_deg > kMostHeading) {
    return 0.0;
  }
  const Eigen::Affine3d local = localGuess(fixed, moving, guess);
  const std::size_t stride = std::max<std::size_t>(1, moving.size() / kSamples);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> points;
  for (std::size_t i = 0; i < moving.size(); i += stride) {
    points.emplace_back((local * moving.xyz[i].cast<double>()).head<2>());
    sum += points.back();
  }
  const Eigen::Vector2d mean = sum / static_cast<double>(points.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(scatter /
                                                             static_cast<double>(points.size()));
  // Of an even line the deviation is its length over the root of twelve.
  const Eigen::Vector2d sizes = (12.0 * eigen.eigenvalues().cwiseMax(0.0)).cwiseSqrt();
  if (!(sizes[1] > from && sizes[1] > kLeastLength * sizes[0])) return 0.0;
  const Eigen::Vector2d along = eigen.eigenvectors().col(1);
  return -std::atan(along.y() / along.x());
}

void levelFixed(const FixedCloud& fixed, const map::LevelOptions& options, PairFrames& frames) {
  frames.fixed = fixed.levelling(options);
  frames.levelled_from_fixed = turned(frames.turn) * frames.fixed.levelled_from_guess;
  // What is turned is so for one strip.
  frames.fixed_footprint = frames.turn == 0.0
                               ? fixed.footprint(options)
                               : map::footprintOf(fixed.points(), frames.levelled_from_fixed);
}

void levelMoving(const CloudFacts& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const map::LevelOptions& options, PairFrames& frames) {
  const Eigen::Affine3d guess_local = localGuess(fixed, moving, guess);
  frames.moving = map::levelCloud(moving, guess_local, options);
  frames.levelled_from_moving =
      turned(frames.turn) * frames.moving.levelled_from_guess * guess_local;
  frames.moving_footprint = map::footprintOf(moving, frames.levelled_from_moving);
}

void requirePlausibleExtents(const CloudFacts& fixed, const Cloud& moving,
                             const map::Box2& fixed_box, const map::Box2& moving_box) {
  if (moving_box.volume() <= kMaxAreaRatio * fixed_box.volume()) return;
  throw InputError(fmt::format(
      "{}: covers {:.3g} x {:.3g} m, far more than the fixed map {} with {:.3g} x {:.3g} m; are "
      "FIXED and MOVING swapped, or their units different?",
      moving.name, moving_box.sizes().x(), moving_box.sizes().y(), fixed.name,
      fixed_box.sizes().x(), fixed_box.sizes().y()));
}

/// Where the file's x and y axes point from above. One that stands upright points nowhere: then
/// across the other one.
Eigen::Matrix2d axesFromAbove(const Eigen::Matrix3d& levelled_from_moving) {
  constexpr double kLeast = 0.5;
  const Eigen::Matrix2d both = levelled_from_moving.topLeftCorner<2, 2>();
  const Eigen::RowVector2d lengths = both.colwise().norm();
  Eigen::Matrix2d axes = both.colwise().normalized();
  if (lengths.minCoeff() >= kLeast * lengths.maxCoeff() && std::abs(axes.determinant()) >= kLeast) {
    return axes;
  }
  if (lengths.x() >= lengths.y()) {
    axes.col(1) = Eigen::Vector2d(-axes(1, 0), axes(0, 0));
  } else {
    axes.col(0) = Eigen::Vector2d(axes(1, 1), -axes(0, 1));
  }
  return axes;
}

SearchSpace searchSpace(const map::Box2& moving, const PairFrames& frames,
                        const PriorUncertainty& uncertainty) {
  SearchSpace space;
  space.uncertainty = uncertainty;
  space.turn = frames.turn;
  space.centre = moving.center();
  space.scale_axes = axesFromAbove(frames.levelled_from_moving.linear());
  return space;
}

map::Box2 reachableWindow(const map::Box2& moving, const SearchSpace& space, double rim) {
  const double heading = space.uncertainty.heading_deg * std::numbers::pi / 180.0;
  const double stretch = std::exp(logScaleLimit(space.uncertainty));
  map::Box2 window;
  for (int corner = 0; corner < 4; ++corner) {
    const Eigen::Vector2d arm =
        stretch * (moving.corner(static_cast<map::Box2::CornerType>(corner)) - space.centre);
    for (const double yaw : {-heading, 0.0, heading}) {
      window.extend((space.centre + rotation2(yaw) * arm).eval());
    }
    // Between these headings an arm reaches farthest where it comes to lie along an axis.
    const double direction = std::atan2(arm.y(), arm.x());
    for (int axis = 0; axis < 4; ++axis) {
      const double along = 0.5 * std::numbers::pi * axis;
      if (std::abs(std::remainder(along - direction, 2.0 * std::numbers::pi)) > heading) continue;
      window.extend(
          (space.centre + arm.norm() * Eigen::Vector2d(std::cos(along), std::sin(along))).eval());
    }
  }
  const double margin = space.uncertainty.translation + rim;
  window.extend((window.min() - Eigen::Vector2d::Constant(margin)).eval());
  window.extend((window.max() + Eigen::Vector2d::Constant(margin)).eval());
  return window;
}

}  // namespace agricolmap::pipeline
