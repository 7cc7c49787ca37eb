#include "agricolmap/pipeline/pair_maps.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/transform.hpp"

namespace agricolmap::pipeline {
namespace {

// Beyond this ratio of areas "moving" and "fixed" were swapped, or one is in other units.
constexpr double kMaxAreaRatio = 4.0;

struct PointSum {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  PointSum& operator+=(const PointSum& other) {
    sum += other.sum;
    return *this;
  }
};

}  // namespace

Eigen::Vector3d meanOf(const Cloud& cloud) {
  if (cloud.xyz.empty()) return cloud.origin;
  const PointSum total =
      parallelSum<PointSum>(cloud.size(), 1U << 16, {}, [&](std::size_t begin, std::size_t end) {
        PointSum part;
        for (std::size_t i = begin; i < end; ++i) part.sum += cloud.xyz[i].cast<double>();
        return part;
      });
  return cloud.origin + total.sum / static_cast<double>(cloud.size());
}

Eigen::Affine3d centredGuess(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                             const PriorUncertainty& uncertainty) {
  if (!uncertainty.anywhere()) return guess;
  return Eigen::Translation3d(meanOf(fixed) - guess * meanOf(moving)) * guess;
}

void levelFixed(const Cloud& fixed, const map::LevelOptions& options, PairFrames& frames) {
  frames.fixed = map::levelCloud(fixed, Eigen::Affine3d::Identity(), options);
  frames.levelled_from_fixed = frames.fixed.levelled_from_guess;
  frames.fixed_footprint = map::footprintOf(fixed, frames.levelled_from_fixed);
}

void levelMoving(const Cloud& fixed, const Cloud& moving, const Eigen::Affine3d& guess,
                 const map::LevelOptions& options, PairFrames& frames) {
  // In double and about the origins, so that UTM coordinates cancel before anything is float.
  const Eigen::Affine3d guess_local =
      Eigen::Translation3d(-fixed.origin) * guess * Eigen::Translation3d(moving.origin);
  frames.moving = map::levelCloud(moving, guess_local, options);
  frames.levelled_from_moving = frames.moving.levelled_from_guess * guess_local;
  frames.moving_footprint = map::footprintOf(moving, frames.levelled_from_moving);
}

void requirePlausibleExtents(const Cloud& fixed, const Cloud& moving, const map::Box2& fixed_box,
                             const map::Box2& moving_box) {
  if (moving_box.volume() <= kMaxAreaRatio * fixed_box.volume()) return;
  throw InputError(fmt::format(
      "{}: covers {:.3g} x {:.3g} m, far more than the fixed map {} with {:.3g} x {:.3g} m; are "
      "FIXED and MOVING swapped, or their units different?",
      moving.name, moving_box.sizes().x(), moving_box.sizes().y(), fixed.name,
      fixed_box.sizes().x(), fixed_box.sizes().y()));
}

SearchSpace searchSpace(const map::Box2& moving, const PairFrames& frames,
                        const PriorUncertainty& uncertainty) {
  SearchSpace space;
  space.uncertainty = uncertainty;
  space.centre = moving.center();
  const Eigen::Matrix2d axes = frames.levelled_from_moving.linear().topLeftCorner<2, 2>();
  space.scale_axes = axes.colwise().normalized();
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
