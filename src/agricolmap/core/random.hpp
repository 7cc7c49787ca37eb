// Random numbers that are the same on every machine and compiler: the standard's engines are
// specified to the bit, its distributions are not.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

namespace agricolmap {

/// Spreads what tells two numbers apart over all 64 bits (the finaliser of SplitMix64).
constexpr std::uint64_t mixBits(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// SplitMix64 (Steele et al. 2014): tiny state, good enough for simulation and sampling.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// An independent stream for item `i` of a seed.
  static Random stream(std::uint64_t seed, std::uint64_t i) {
    Random mixer(seed ^ (0xD1B54A32D192ED03ULL * (i + 1)));
    return Random(mixer.bits());
  }
  /// From one state to the next: 2⁶⁴ over the golden ratio.
  static constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ULL;
  std::uint64_t bits() { return mixBits(state_ += kStep); }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1.0p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in [0, n).
  std::uint64_t below(std::uint64_t n) {
    return static_cast<std::uint64_t>(uniform() * static_cast<double>(n));
  }
  bool chance(double probability) { return uniform() < probability; }
  /// Normal with mean 0 and the given standard deviation (Box–Muller).
  double normal(double sigma = 1.0) {
    const double u = 1.0 - uniform();
    return sigma * std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  std::uint64_t state_;
};

}  // namespace agricolmap
