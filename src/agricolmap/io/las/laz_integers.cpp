#include "agricolmap/io/las/laz_integers.hpp"

#include <algorithm>

namespace agricolmap::io {
namespace {

constexpr std::uint32_t kShortestInterval = 1U << 24;
constexpr std::uint32_t kSymbolBits = 15;
constexpr std::uint32_t kBitBits = 13;
/// Errors have up to 32 bits, of which the upper eight are modelled and the others are not.
constexpr std::size_t kErrorBits = 32;
constexpr std::uint32_t kModelledBits = 8;

}  // namespace

LazIntegers::Symbols::Symbols(std::size_t count)
    : counts_(count, 1), starts_(count, 0), cycle_(static_cast<std::uint32_t>(count)) {
  update();
  cycle_ = (static_cast<std::uint32_t>(count) + 6) / 2;
  until_update_ = cycle_;
}

void LazIntegers::Symbols::update() {
  const auto count = static_cast<std::uint32_t>(counts_.size());
  total_ += cycle_;
  if (total_ > 1U << kSymbolBits) {
    total_ = 0;
    for (std::uint32_t& n : counts_) {
      n = (n + 1) / 2;
      total_ += n;
    }
  }
  const std::uint32_t scale = 0x80000000U / total_;
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    starts_[i] = (scale * sum) >> (31 - kSymbolBits);
    sum += counts_[i];
  }
  cycle_ = std::min(5 * cycle_ / 4, (count + 6) * 8);
  until_update_ = cycle_;
}

std::size_t LazIntegers::Symbols::decode(LazIntegers& decoder) {
  const std::uint32_t whole = decoder.length_;
  const std::uint32_t unit = whole >> kSymbolBits;
  // The last symbol that does not start behind the value.
  const auto it = std::upper_bound(
      starts_.begin() + 1, starts_.end(), decoder.value_,
      [&](std::uint32_t value, std::uint32_t start) { return value < start * unit; });
  const auto symbol = static_cast<std::size_t>(it - starts_.begin()) - 1;
  const std::uint32_t begin = starts_[symbol] * unit;
  const std::uint32_t end = it == starts_.end() ? whole : *it * unit;
  decoder.value_ -= begin;
  decoder.length_ = end - begin;
  decoder.renormalise();
  ++counts_[symbol];
  if (--until_update_ == 0) update();
  return symbol;
}

std::uint32_t LazIntegers::Bit::decode(LazIntegers& decoder) {
  const std::uint32_t split = start_of_one_ * (decoder.length_ >> kBitBits);
  const std::uint32_t bit = decoder.value_ >= split ? 1 : 0;
  if (bit == 0) {
    decoder.length_ = split;
    ++zeros_;
  } else {
    decoder.value_ -= split;
    decoder.length_ -= split;
  }
  decoder.renormalise();
  if (--until_update_ == 0) update();
  return bit;
}

void LazIntegers::Bit::update() {
  total_ += cycle_;
  if (total_ > 1U << kBitBits) {
    total_ = (total_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == total_) ++total_;
  }
  const std::uint32_t scale = 0x80000000U / total_;
  start_of_one_ = (zeros_ * scale) >> (31 - kBitBits);
  cycle_ = std::min(5 * cycle_ / 4, std::uint32_t{64});
  until_update_ = cycle_;
}

LazIntegers::LazIntegers(std::span<const std::byte> bytes)
    : bytes_(bytes), sizes_{Symbols(kErrorBits + 1), Symbols(kErrorBits + 1)} {
  for (std::uint32_t bits = 1; bits < kErrorBits; ++bits) {
    errors_.emplace_back(std::size_t{1} << std::min(bits, kModelledBits));
  }
  for (int i = 0; i < 4; ++i) value_ = value_ << 8 | takeByte();
}

std::uint32_t LazIntegers::takeByte() {
  if (next_ == bytes_.size()) {
    beyond_end_ = true;
    return 0;
  }
  return std::to_integer<std::uint32_t>(bytes_[next_++]);
}

void LazIntegers::renormalise() {
  // An interval of no length is what damaged bytes make.
  if (length_ == 0) {
    beyond_end_ = true;
    length_ = kShortestInterval;
  }
  while (length_ < kShortestInterval) {
    value_ = value_ << 8 | takeByte();
    length_ <<= 8;
  }
}

std::uint32_t LazIntegers::decodeBits(std::uint32_t count) {
  constexpr std::uint32_t kMost = 19;
  if (count > kMost) {
    const std::uint32_t lower = decodeBits(16);
    return decodeBits(count - 16) << 16 | lower;
  }
  length_ >>= count;
  const std::uint32_t bits = value_ / length_;
  value_ -= bits * length_;
  renormalise();
  return bits;
}

std::uint32_t LazIntegers::next(std::uint32_t predicted, std::size_t stream) {
  const auto size = static_cast<std::uint32_t>(sizes_[stream].decode(*this));
  if (size == 0) return predicted + small_error_.decode(*this);
  if (size == kErrorBits) return predicted + 0x80000000U;  // the least integer, and it alone
  auto error = static_cast<std::uint32_t>(errors_[size - 1].decode(*this));
  if (size > kModelledBits) {
    const std::uint32_t lower_bits = size - kModelledBits;
    error = error << lower_bits | decodeBits(lower_bits);
  }
  // Of 2^size errors the upper half are positive and begin at 2^(size-1) + 1, the lower half are
  // negative and end at -2^(size-1).
  const std::uint32_t half = 1U << (size - 1);
  return predicted + (error >= half ? error + 1 : error - ((1U << size) - 1));
}

}  // namespace agricolmap::io
