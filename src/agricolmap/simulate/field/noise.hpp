// Smooth random fields that depend on a seed and the place only, so that two views of one field see
// the same soil whatever window each looks at.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "agricolmap/core/random.hpp"

namespace agricolmap::simulate {

/// Mixes two numbers into 64 well-spread bits.
inline std::uint64_t hashBits(std::uint64_t seed, std::uint64_t key) {
  return mixBits(seed + Random::kStep * (key + 1));
}

inline std::uint64_t hashBits(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  return hashBits(seed, (static_cast<std::uint64_t>(i) << 32) ^
                            (static_cast<std::uint64_t>(j) & 0xFFFFFFFFULL));
}

/// Uniform in [0, 1) from a hash.
inline float hashUniform(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  return static_cast<float>(hashBits(seed, i, j) >> 40) * 0x1.0p-24F;
}

/// Value of the noise's lattice. The factor makes the interpolated field's deviation about 1.
inline float latticeValue(std::uint64_t seed, std::int64_t i, std::int64_t j) {
  return 4.6F * (hashUniform(seed, i, j) - 0.5F);
}

inline float smoothStep(float t) { return t * t * (3.0F - 2.0F * t); }

/// Value noise with features of size 1: mean 0, deviation about 1.
inline float noiseAt(std::uint64_t seed, double x, double y) {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto i = static_cast<std::int64_t>(fx);
  const auto j = static_cast<std::int64_t>(fy);
  const float sx = smoothStep(static_cast<float>(x - fx));
  const float sy = smoothStep(static_cast<float>(y - fy));
  const float low = latticeValue(seed, i, j) * (1.0F - sx) + latticeValue(seed, i + 1, j) * sx;
  const float high =
      latticeValue(seed, i, j + 1) * (1.0F - sx) + latticeValue(seed, i + 1, j + 1) * sx;
  return low * (1.0F - sy) + high * sy;
}

/// What a standard normal deviate exceeds with this probability; beyond all values for 0 or 1.
inline float normalQuantile(double exceeded) {
  if (exceeded <= 0.0) return 1e9F;
  if (exceeded >= 1.0) return -1e9F;
  double low = -6.0;
  double high = 6.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::sqrt(2.0)) > exceeded ? low : high) = middle;
  }
  return static_cast<float>(low);
}

/// The same field as noiseAt, with the lattice of a region tabulated: for rasters.
class NoiseTile {
 public:
  /// Region in units of the noise's features.
  NoiseTile(std::uint64_t seed, double x_min, double x_max, double y_min, double y_max)
      : i0_(static_cast<std::int64_t>(std::floor(x_min)) - 1),
        j0_(static_cast<std::int64_t>(std::floor(y_min)) - 1),
        cols_(static_cast<int>(static_cast<std::int64_t>(std::floor(x_max)) - i0_) + 3),
        rows_(static_cast<int>(static_cast<std::int64_t>(std::floor(y_max)) - j0_) + 3),
        values_(static_cast<std::size_t>(cols_) * static_cast<std::size_t>(rows_)) {
    for (int j = 0; j < rows_; ++j) {
      for (int i = 0; i < cols_; ++i) {
        values_[static_cast<std::size_t>(j) * cols_ + i] = latticeValue(seed, i0_ + i, j0_ + j);
      }
    }
  }
  float operator()(double x, double y) const {
    const float lx = static_cast<float>(x - static_cast<double>(i0_));
    const float ly = static_cast<float>(y - static_cast<double>(j0_));
    const int i = static_cast<int>(lx);
    const int j = static_cast<int>(ly);
    const float sx = smoothStep(lx - static_cast<float>(i));
    const float sy = smoothStep(ly - static_cast<float>(j));
    const float* p = values_.data() + static_cast<std::size_t>(j) * cols_ + i;
    const float low = p[0] + (p[1] - p[0]) * sx;
    const float high = p[cols_] + (p[cols_ + 1] - p[cols_]) * sx;
    return low + (high - low) * sy;
  }

 private:
  std::int64_t i0_;
  std::int64_t j0_;
  int cols_;
  int rows_;
  std::vector<float> values_;
};

}  // namespace agricolmap::simulate
