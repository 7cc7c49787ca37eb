// Small fields for the tests of shared maps.
#pragma once

#include <algorithm>
#include <cmath>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/random.hpp"

namespace agricolmap::test {

inline constexpr Rgb kSoil{120, 100, 80};
inline constexpr Rgb kPlant{60, 140, 50};

/// Points on a lattice of `spacing` from `low` to `high`, at `height(x, y)`, soil-coloured.
template <typename Height>
Cloud groundCloud(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double spacing,
                  const Height& height) {
  Cloud cloud;
  for (double y = low.y() + 0.5 * spacing; y < high.y(); y += spacing) {
    for (double x = low.x() + 0.5 * spacing; x < high.x(); x += spacing) {
      cloud.xyz.emplace_back(Eigen::Vector3d(x, y, height(x, y)).cast<float>());
      cloud.rgb.push_back(kSoil);
    }
  }
  return cloud;
}

/// Rows of round plants, half a metre apart, 0.25 m tall and 0.3 m wide.
inline double plantHeight(double x, double y) {
  const double dx = x - 0.5 * std::round(x / 0.5), dy = y - 0.5 * std::round(y / 0.5);
  const double r = std::hypot(dx, dy);
  return r < 0.15 ? 0.25 * (1.0 - 0.3 * r / 0.15) : 0.0;
}

/// The field as seen by somebody who sees `share` of the plants' height, laid `up` too high, with
/// noise.
inline Cloud plantCloud(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double spacing,
                        double share, double up, std::uint64_t seed) {
  Cloud cloud = groundCloud(low, high, spacing, [](double, double) { return 0.0; });
  Random random(seed);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    Eigen::Vector3f& p = cloud.xyz[i];
    const double plant = plantHeight(p.x(), p.y());
    p.z() = static_cast<float>(share * plant + up + 0.003 * random.normal());
    const auto grain = static_cast<int>(6.0 * random.normal());
    const Rgb base = plant > 0.0 ? kPlant : kSoil;
    const auto shade = [&](std::uint8_t value) {
      return static_cast<std::uint8_t>(std::clamp(value + grain, 0, 255));
    };
    cloud.rgb[i] = {shade(base.r), shade(base.g), shade(base.b)};
  }
  return cloud;
}

}  // namespace agricolmap::test
