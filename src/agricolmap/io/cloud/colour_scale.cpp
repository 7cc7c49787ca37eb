#include "agricolmap/io/cloud/colour_scale.hpp"

#include <algorithm>

namespace agricolmap::io {
namespace {

constexpr std::uint64_t kMostStrays = 1000;  ///< one in so many
constexpr float kWhite = 255.0F;

constexpr std::array<ColourScale, kColourRanges.size()> makeScales() {
  std::array<ColourScale, kColourRanges.size()> scales;
  for (std::size_t i = 0; i < scales.size(); ++i) {
    const float range = kColourRanges[i];
    const float half_step = 0.5F * range / kWhite;
    scales[i] = {kWhite / range, -std::min(half_step, 0.5F), range + half_step};
  }
  return scales;
}
constexpr auto kScales = makeScales();

}  // namespace

ColourScale scaleOfRange(std::size_t range) { return kScales[range]; }

void ColourTally::take(float least, float most) {
  coloured += least != 0.0F || most != 0.0F ? 1 : 0;
  for (std::size_t i = 0; i < kScales.size(); ++i) {
    outside[i] += kScales[i].holds(least, most) ? 0 : 1;
  }
  low = std::min(low, least);
  high = std::max(high, most);
}

ColourTally& ColourTally::operator+=(const ColourTally& other) {
  coloured += other.coloured;
  for (std::size_t i = 0; i < outside.size(); ++i) outside[i] += other.outside[i];
  low = std::min(low, other.low);
  high = std::max(high, other.high);
  return *this;
}

std::optional<ColourScale> ColourTally::scale(ColourKind kind) const {
  const std::size_t first = kind == ColourKind::kWideFloat ? 0 : 1;
  for (std::size_t i = first; i < kScales.size(); ++i) {
    if (outside[i] * kMostStrays <= coloured) return kScales[i];
  }
  return std::nullopt;
}

}  // namespace agricolmap::io
