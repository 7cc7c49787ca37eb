#include "agricolmap/change/distribution.hpp"

#include <algorithm>
#include <cmath>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/core/round_step.hpp"

namespace agricolmap::change {
namespace {

constexpr double kLeastReach = 0.02;  // [m]
constexpr double kWithin = 0.99;      // of the changes

}  // namespace

double reachOf(const Raster<float>& change) {
  std::vector<float> sizes;
  for (const float value : change) {
    if (!std::isnan(value)) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return kLeastReach;
  const double reach = std::max(kLeastReach, static_cast<double>(quantile(sizes, kWithin)));
  const double step = roundStep(reach);
  return step * std::ceil(reach / step);
}

Distribution distributionOf(const HeightChange& change, int bins) {
  Distribution found{reachOf(change.change),
                     std::vector<Distribution::Bin>(static_cast<std::size_t>(bins))};
  for (std::size_t i = 0; i < change.change.size(); ++i) {
    if (std::isnan(change.change[i])) continue;
    const double at = bins * 0.5 * (1.0 + static_cast<double>(change.change[i]) / found.reach);
    Distribution::Bin& bin = found.bins[static_cast<std::size_t>(std::clamp(at, 0.0, bins - 1.0))];
    (change.significant[i] > 0.0F ? bin.sure : bin.unsure) += 1.0;
  }
  return found;
}

}  // namespace agricolmap::change
