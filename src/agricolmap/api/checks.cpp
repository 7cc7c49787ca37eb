#include "agricolmap/api/checks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "agricolmap/core/error.hpp"

namespace agricolmap {

void requireWhole(const Cloud& cloud) {
  if (cloud.hasColour() && cloud.rgb.size() != cloud.xyz.size()) {
    throw InputError(fmt::format("{}: has {} colours for {} points; give one each, or none",
                                 cloud.name, cloud.rgb.size(), cloud.xyz.size()));
  }
  const bool finite =
      cloud.origin.allFinite() && std::all_of(cloud.xyz.begin(), cloud.xyz.end(),
                                              [](const auto& point) { return point.allFinite(); });
  if (!finite) {
    throw InputError(fmt::format(
        "{}: has coordinates that are not finite; leave such points out, as makeCloud does",
        cloud.name));
  }
}

ThreadLimit threadLimit(const Control& control) {
  if (control.threads < 0) throw UsageError("a number of threads below 0; 0 means all cores");
  return ThreadLimit(control.threads);
}

}  // namespace agricolmap
