#include "agricolmap/io/cloud/hole_height.hpp"

#include <algorithm>
#include <cmath>

namespace agricolmap::io {
namespace {

constexpr double kLeastGap = 30.0;  ///< [m]
constexpr double kGapPerSpread = 3.0;
constexpr double kTail = 0.01;

}  // namespace

void LowestHeights::take(double height) {
  if (height > lowest) {
    next = std::min(next, height);
  } else if (height < lowest) {
    next = lowest;
    lowest = height;
  }
}

LowestHeights& LowestHeights::operator+=(const LowestHeights& other) {
  take(other.lowest);
  take(other.next);
  return *this;
}

std::optional<double> holeHeight(const LowestHeights& heights, std::vector<double> samples) {
  if (!std::isfinite(heights.next) || !(heights.next - heights.lowest > kLeastGap)) {
    return std::nullopt;
  }
  samples.erase(std::remove(samples.begin(), samples.end(), heights.lowest), samples.end());
  if (samples.empty()) return std::nullopt;
  std::sort(samples.begin(), samples.end());
  const auto last = static_cast<double>(samples.size() - 1);
  const double low = samples[static_cast<std::size_t>(kTail * last)];
  const double high = samples[static_cast<std::size_t>((1.0 - kTail) * last)];
  if (heights.next - heights.lowest <= kGapPerSpread * (high - low)) return std::nullopt;
  return heights.lowest;
}

}  // namespace agricolmap::io
