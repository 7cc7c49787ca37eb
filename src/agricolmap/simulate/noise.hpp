// Smooth random functions of the plane, the same on every machine.
#pragma once

#include <cmath>
#include <cstdint>

#include "agricolmap/core/random.hpp"

namespace agricolmap {

/// Value noise: random values in [−1, 1] on a lattice of `cell` metres, smoothly interpolated.
class SmoothNoise {
 public:
  SmoothNoise(std::uint64_t seed, double cell) : seed_(seed), inverse_(1.0 / cell) {}

  double at(double x, double y) const {
    const double u = x * inverse_, v = y * inverse_;
    const double fu = std::floor(u), fv = std::floor(v);
    const auto i = static_cast<std::int64_t>(fu);
    const auto j = static_cast<std::int64_t>(fv);
    const double s = ease(u - fu), t = ease(v - fv);
    const double a = value(i, j) + s * (value(i + 1, j) - value(i, j));
    const double b = value(i, j + 1) + s * (value(i + 1, j + 1) - value(i, j + 1));
    return a + t * (b - a);
  }

 private:
  static double ease(double t) { return t * t * (3.0 - 2.0 * t); }
  double value(std::int64_t i, std::int64_t j) const {
    std::uint64_t h = seed_ ^ (static_cast<std::uint64_t>(i) * 0x9E3779B97F4A7C15ULL) ^
                      (static_cast<std::uint64_t>(j) * 0xC2B2AE3D27D4EB4FULL);
    h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93ULL;
    h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93ULL;
    return static_cast<double>((h ^ (h >> 32)) >> 11) * 0x1.0p-52 - 1.0;
  }
  std::uint64_t seed_;
  double inverse_;
};

}  // namespace agricolmap
