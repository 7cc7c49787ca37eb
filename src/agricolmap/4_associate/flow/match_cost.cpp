#include "agricolmap/4_associate/flow/match_cost.hpp"

#include <bit>
#include <cstdlib>
#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace agricolmap {

void describe(OptionTable& table, CostOptions& options) {
  table.number("alpha", options.alpha, 0.0, 100.0, "", "weight of DAISY in the matching cost");
  table.number("beta", options.beta, 0.0, 100.0, "", "weight of FPFH in the matching cost");
}

namespace {

constexpr int kLeastPoints = 5;  ///< of DAISY's 16
/// Mean absolute difference per byte of unrelated cells of 2 cm, measured on simulated beet and
/// soybean. Coarser cells differ less, in heights above all, which takes weight from FPFH there.
constexpr double kUnrelatedDaisy = 33.0;
constexpr double kUnrelatedFpfh = 13.0;

/// Bytes 0xFF where the sample point counts: eight bytes per bit, four points per row of the table.
struct MaskTable {
  alignas(32) std::array<std::array<std::uint8_t, 32>, 16> rows{};
  constexpr MaskTable() {
    for (std::size_t bits = 0; bits < 16; ++bits) {
      for (std::size_t k = 0; k < 32; ++k) {
        rows[bits][k] = ((bits >> (k / kDaisyOrientations)) & 1U) != 0 ? 0xFF : 0;
      }
    }
  }
};
constexpr MaskTable kMasks;

static_assert(kDaisySize == 2 * 64, "a half of DAISY is a cache line");

// daisyDifference: of the sample points in `bits`, of which half 0 or 1 of the descriptor has
// eight.

#ifdef __AVX2__

__m256i load(const std::uint8_t* p) {
  __m256i value;
  std::memcpy(&value, p, sizeof value);
  return value;
}

int sumLanes(__m256i sums) {
  const __m128i half =
      _mm_add_epi64(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
  return _mm_cvtsi128_si32(half) + _mm_extract_epi32(half, 2);
}

int daisyDifference(const std::uint8_t* a, const std::uint8_t* b, std::uint32_t bits, int half) {
  __m256i sum = _mm256_setzero_si256();
  for (std::ptrdiff_t block = 2 * half; block < 2 * half + 2; ++block) {
    const __m256i mask = load(kMasks.rows[(bits >> (4 * block)) & 15U].data());
    sum = _mm256_add_epi64(sum, _mm256_sad_epu8(_mm256_and_si256(mask, load(a + 32 * block)),
                                                _mm256_and_si256(mask, load(b + 32 * block))));
  }
  return sumLanes(sum);
}

int fpfhDifference(const std::uint8_t* a, const std::uint8_t* b) {
  return sumLanes(_mm256_sad_epu8(load(a), load(b))) +
         std::abs(static_cast<int>(a[32]) - static_cast<int>(b[32]));
}

#else

int daisyDifference(const std::uint8_t* a, const std::uint8_t* b, std::uint32_t bits, int half) {
  int sum = 0;
  for (std::ptrdiff_t block = 2 * half; block < 2 * half + 2; ++block) {
    const auto& mask = kMasks.rows[(bits >> (4 * block)) & 15U];
    for (int k = 0; k < 32; ++k) {
      const int i = 32 * block + k;
      sum += std::abs((a[i] & mask[static_cast<std::size_t>(k)]) -
                      (b[i] & mask[static_cast<std::size_t>(k)]));
    }
  }
  return sum;
}

int fpfhDifference(const std::uint8_t* a, const std::uint8_t* b) {
  int sum = 0;
  for (int k = 0; k < kFpfhSize; ++k) sum += std::abs(a[k] - b[k]);
  return sum;
}

#endif

}  // namespace

MatchCost::MatchCost(const DescriptorMap& fixed, const DescriptorMap& moving,
                     const CostOptions& options)
    : fixed_(&fixed), moving_(&moving) {
  for (int n = 1; n <= kDaisyPoints; ++n) {
    daisy_scale_[static_cast<std::size_t>(n)] =
        static_cast<float>(options.alpha / (kUnrelatedDaisy * kDaisyOrientations * n));
  }
  fpfh_scale_ = static_cast<float>(options.beta / (kUnrelatedFpfh * kFpfhSize));
}

bool MatchCost::usable(std::size_t moving_cell) const {
  const std::uint32_t known = moving_->known[moving_cell];
  const int points = std::popcount(known & DescriptorMap::kDaisyBits);
  // Without any visual channel (term `height`) no DAISY bit is ever set.
  return points == 0 ? (known & DescriptorMap::kFpfhBit) != 0
                     : (known & 1U) != 0 && points >= kLeastPoints;
}

float MatchCost::below(std::size_t fixed_cell, std::size_t moving_cell, float limit) const {
  if (!usable(moving_cell)) return kImpossible;
  const std::uint32_t known = moving_->known[moving_cell];
  const std::uint32_t points = known & DescriptorMap::kDaisyBits;
  const float scale = daisy_scale_[static_cast<std::size_t>(std::popcount(points))];
  const std::uint8_t* fixed = fixed_->daisy(fixed_cell);
  const std::uint8_t* moving = moving_->daisy(moving_cell);
  int difference = daisyDifference(fixed, moving, points, 0);
  if (scale * static_cast<float>(difference) >= limit) return limit;
  difference += daisyDifference(fixed, moving, points, 1);
  float cost = scale * static_cast<float>(difference);
  if (cost >= limit) return limit;
  if ((known & DescriptorMap::kFpfhBit) != 0) {
    cost += fpfh_scale_ * static_cast<float>(
                              fpfhDifference(fixed_->fpfh(fixed_cell), moving_->fpfh(moving_cell)));
  }
  return cost;
}

}  // namespace agricolmap
