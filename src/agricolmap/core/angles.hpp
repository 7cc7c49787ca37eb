// Degrees for people, radians for the maths, and angles that go round.
#pragma once

#include <cmath>
#include <numbers>

namespace agricolmap {

constexpr double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }
constexpr double degrees(double radians) { return radians * 180.0 / std::numbers::pi; }

/// The same angle [rad] in (−π, π].
inline double wrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * std::numbers::pi);
  return wrapped <= -std::numbers::pi ? wrapped + 2.0 * std::numbers::pi : wrapped;
}

}  // namespace agricolmap
