#include "agricolmap/paper/flow/match_cost.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include "agricolmap/core/random.hpp"

namespace agricolmap::paper {

void listOptions(OptionTable& table, CostOptions& options) {
  table.number("alpha", options.alpha, 0.0, 100.0, "", "weight of DAISY in the matching cost")
      .basic();
  table.number("beta", options.beta, 0.0, 100.0, "", "weight of FPFH in the matching cost").basic();
  table.flag(
      "normalise", options.normalise,
      "each descriptor's difference over its spread between unrelated cells, not the paper's "
      "plain sum");
}

namespace {

constexpr int kLeastPoints = 5;  ///< of DAISY's 16
constexpr int kSpreadPairs = 2000;
constexpr std::uint64_t kSpreadSeed = 1;
/// Where differences vary by less than a byte, they are mostly what rounding makes them.
constexpr double kLeastSpread = 1.0;

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
  const std::ptrdiff_t first = std::ptrdiff_t{2} * half;
  for (std::ptrdiff_t block = first; block < first + 2; ++block) {
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
  const std::ptrdiff_t first = std::ptrdiff_t{2} * half;
  for (std::ptrdiff_t block = first; block < first + 2; ++block) {
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

/// Running mean and variance (Welford).
class Moments {
 public:
  void add(double value) {
    ++count_;
    const double from_mean = value - mean_;
    mean_ += from_mean / count_;
    squares_ += from_mean * (value - mean_);
  }
  double deviation() const { return count_ > 0 ? std::sqrt(squares_ / count_) : 0.0; }

 private:
  int count_ = 0;
  double mean_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace

bool usable(const DescriptorMap& moving, std::size_t cell) {
  const std::uint32_t known = moving.known[cell];
  const int points = std::popcount(known & DescriptorMap::kDaisyBits);
  // Without any visual channel (term `height`) no DAISY bit is ever set.
  return points == 0 ? (known & DescriptorMap::kFpfhBit) != 0
                     : (known & 1U) != 0 && points >= kLeastPoints;
}

UnrelatedSpread unrelatedSpread(const DescriptorMap& fixed, const DescriptorMap& moving) {
  Moments daisy;
  Moments fpfh;
  if (fixed.known.empty() || moving.known.empty()) return {};
  Random random(kSpreadSeed);
  for (int k = 0; k < kSpreadPairs; ++k) {
    const std::size_t a = random.below(fixed.known.size());
    const std::size_t b = random.below(moving.known.size());
    if (!fixed.describes(a) || !usable(moving, b)) continue;
    const std::uint32_t points = moving.known[b] & DescriptorMap::kDaisyBits;
    if (points != 0) {
      const int difference = daisyDifference(fixed.daisy(a), moving.daisy(b), points, 0) +
                             daisyDifference(fixed.daisy(a), moving.daisy(b), points, 1);
      daisy.add(static_cast<double>(difference) / (kDaisyOrientations * std::popcount(points)));
    }
    if ((fixed.known[a] & moving.known[b] & DescriptorMap::kFpfhBit) != 0) {
      fpfh.add(static_cast<double>(fpfhDifference(fixed.fpfh(a), moving.fpfh(b))) / kFpfhSize);
    }
  }
  return {daisy.deviation(), fpfh.deviation()};
}

MatchCost::MatchCost(const DescriptorMap& fixed, const DescriptorMap& moving,
                     const CostOptions& options)
    : fixed_(&fixed), moving_(&moving) {
  // What a difference of one byte costs, were all points known.
  double daisy = options.alpha;
  double fpfh = options.beta;
  if (options.normalise) {
    const UnrelatedSpread spread = unrelatedSpread(fixed, moving);
    daisy /= std::max(kLeastSpread, spread.daisy) * kDaisySize;
    fpfh /= std::max(kLeastSpread, spread.fpfh) * kFpfhSize;
  }
  for (int n = 1; n <= kDaisyPoints; ++n) {
    daisy_scale_[static_cast<std::size_t>(n)] = static_cast<float>(daisy * kDaisyPoints / n);
  }
  fpfh_scale_ = static_cast<float>(fpfh);
}

float MatchCost::below(std::size_t fixed_cell, std::size_t moving_cell, float limit) const {
  if (!usable(*moving_, moving_cell)) return kImpossible;
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

}  // namespace agricolmap::paper
