// What range the wide colours of a file are in: 0–1, 0–255 or 0–65535. Files do not say; what
// nearly all of their colours tell is believed, and no single one decides.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

/// The ranges that colours may be in, narrowest first.
inline constexpr std::array<float, 3> kColourRanges{1.0F, 255.0F, 65535.0F};

/// The range of a file's colours. What rounds to a limit is at it.
struct ColourScale {
  float factor = 1.0F;  ///< to 0–255
  float low = 0.0F;
  float high = 255.0F;

  bool holds(float least, float most) const { return least >= low && most <= high; }
};

/// That of kColourRanges[range].
ColourScale scaleOfRange(std::size_t range);

/// A wide channel in 0–255, by the `factor` of its range.
inline std::uint8_t narrowed(float wide, float factor) {
  return static_cast<std::uint8_t>(std::clamp(factor * wide + 0.5F, 0.0F, 255.0F));
}

/// Which ranges the colours of many points fit.
struct ColourTally {
  std::uint64_t coloured = 0;  ///< points that are not black: black fits any range
  std::array<std::uint64_t, kColourRanges.size()> outside{};  ///< of kColourRanges
  float low = 0.0F;
  float high = 0.0F;

  /// A point by its least and its largest channel.
  void take(float least, float most);
  ColourTally& operator+=(const ColourTally& other);
  /// The narrowest range that holds all but one in a thousand of the coloured points; nothing where
  /// none does. Integers of 0 and 1 are of 0–255.
  std::optional<ColourScale> scale(ColourKind kind) const;
};

}  // namespace agricolmap::io
