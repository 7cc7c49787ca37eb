#include "agricolmap/paper/flow/reach.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/scaled_rotation.hpp"

namespace agricolmap::paper {

Reach::Reach(const SearchSpace& space, const Eigen::Affine2d& warp)
    : space_(space),
      warp_(warp),
      unwarp_(warp.inverse()),
      yaw_(radians(space.uncertainty.heading_deg)) {
  // The image is linear in the scales and nearly so in the yaw: corners and centre span it; wide
  // headings need the steps between.
  const int steps = std::max(2, static_cast<int>(std::ceil(2.0 * yaw_ / 0.2)));
  const double widest = std::exp(logScaleLimit(space_.uncertainty));
  for (int i = 0; i <= steps; ++i) {
    const double yaw = -yaw_ + 2.0 * yaw_ * i / steps;
    for (const double scale_x : {1.0 / widest, widest}) {
      for (const double scale_y : {1.0 / widest, widest}) {
        const Eigen::Matrix2d m = YawScales{yaw, {scale_x, scale_y}}.linear(space_.scale_axes);
        extremes_.push_back({m, m.inverse()});
      }
    }
  }
}

Eigen::Matrix2d Reach::randomLinear(Random& random) const {
  const double spread = logScaleLimit(space_.uncertainty);
  const double yaw = random.uniform(-yaw_, yaw_);
  const double log_x = random.uniform(-spread, spread);
  const double log_y = random.uniform(-spread, spread);
  return YawScales::fromVector({yaw, log_x, log_y}).linear(space_.scale_axes);
}

Eigen::Vector2d Reach::randomShift(Random& random) const {
  const double radius = space_.uncertainty.translation * std::sqrt(random.uniform());
  const double angle = 2.0 * std::numbers::pi * random.uniform();
  return radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

Eigen::Vector2d Reach::sampleForward(const Eigen::Vector2d& q, Random& random) const {
  const Eigen::Matrix2d m = randomLinear(random);
  return space_.centre + randomShift(random) + m * (unwarp_ * q - space_.centre);
}

Eigen::Vector2d Reach::sampleBackward(const Eigen::Vector2d& p, Random& random) const {
  const Eigen::Matrix2d m = randomLinear(random);
  const Eigen::Vector2d arm = p - space_.centre - randomShift(random);
  return warp_ * (space_.centre + m.inverse() * arm);
}

template <typename Map>
map::Box2 Reach::boxOver(const Map& map) const {
  map::Box2 box;
  for (const Extreme& extreme : extremes_) box.extend(map(extreme));
  return box;
}

map::Box2 Reach::forwardBox(const Eigen::Vector2d& q) const {
  map::Box2 box = boxOver([&](const Extreme& m) -> Eigen::Vector2d {
    return space_.centre + m.linear * (unwarp_ * q - space_.centre);
  });
  box.min().array() -= space_.uncertainty.translation;
  box.max().array() += space_.uncertainty.translation;
  return box;
}

map::Box2 Reach::backwardBox(const Eigen::Vector2d& p) const {
  const double shift = space_.uncertainty.translation;
  map::Box2 box;
  for (const double x : {-shift, shift}) {
    for (const double y : {-shift, shift}) {
      box.extend(boxOver([&](const Extreme& m) -> Eigen::Vector2d {
        return warp_ * (space_.centre + m.inverse * (p - space_.centre - Eigen::Vector2d(x, y)));
      }));
    }
  }
  return box;
}

}  // namespace agricolmap::paper
