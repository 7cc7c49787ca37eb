// Where between samples a peak lies.
#pragma once

#include <algorithm>

namespace agricolmap {

/// Vertex of the parabola through three values, in steps from the middle one, within half a step;
/// 0 where they have no peak.
inline double parabolaVertex(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

}  // namespace agricolmap
