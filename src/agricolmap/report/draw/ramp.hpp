// Colours for numbers.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace agricolmap::report {

/// Between stops of 0xRRGGBB, evenly spaced: the first at 0, the last at 1 and beyond.
template <std::size_t kStops>
std::uint32_t rampColour(const std::array<std::uint32_t, kStops>& stops, double share) {
  const double at = std::clamp(share, 0.0, 1.0) * (kStops - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kStops - 2);
  const double part = at - static_cast<double>(low);
  std::uint32_t colour = 0;
  for (const unsigned shift : {16U, 8U, 0U}) {
    const double from = (stops[low] >> shift) & 255U, to = (stops[low + 1] >> shift) & 255U;
    colour |= static_cast<std::uint32_t>(std::lround(from + part * (to - from))) << shift;
  }
  return colour;
}

/// From low to high, even to the eye and to those who cannot tell red from green (viridis).
inline constexpr std::array<std::uint32_t, 6> kLowToHigh{0x440154, 0x414487, 0x2a788e,
                                                         0x22a884, 0x7ad151, 0xfde725};
/// From one extreme by nothing to the other (BrBG), for the same eyes.
inline constexpr std::array<std::uint32_t, 5> kFallToRise{0x8c510a, 0xd8b365, 0xf5f5f5, 0x5ab4ac,
                                                          0x01665e};

}  // namespace agricolmap::report
