// Round numbers for scales.
#pragma once

#include <cmath>

namespace agricolmap {

/// A round step that parts `range` into four to ten.
inline double roundStep(double range) {
  const double rough = range / 5.0;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= rough) return factor * power;
  }
  return 10.0 * power;
}

}  // namespace agricolmap
