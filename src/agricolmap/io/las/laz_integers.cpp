#include "agricolmap/io/las/laz_integers.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace agricolmap::io {
namespace {

constexpr std::uint32_t kShortestInterval = 1U << 24;
/// Errors have up to 32 bits, of which the upper eight are modelled and the others are not.
constexpr std::uint32_t kErrorBits = 32;
constexpr std::uint32_t kModelledBits = 8;
/// More bits than that are coded in two parts.
constexpr std::uint32_t kMostBits = 19;
constexpr std::uint32_t kLowerBits = 16;

}  // namespace

LazSymbols::LazSymbols(std::size_t count)
    : counts_(count, 1), starts_(count, 0), cycle_(static_cast<std::uint32_t>(count)) {
  update();
  cycle_ = (static_cast<std::uint32_t>(count) + 6) / 2;
  until_update_ = cycle_;
}

void LazSymbols::update() {
  const auto count = static_cast<std::uint32_t>(counts_.size());
  total_ += cycle_;
  if (total_ > 1U << kBits) {
    total_ = 0;
    for (std::uint32_t& n : counts_) {
      n = (n + 1) / 2;
      total_ += n;
    }
  }
  const std::uint32_t scale = 0x80000000U / total_;
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    starts_[i] = (scale * sum) >> (31 - kBits);
    sum += counts_[i];
  }
  cycle_ = std::min(5 * cycle_ / 4, (count + 6) * 8);
  until_update_ = cycle_;
}

void LazSymbols::count(std::size_t symbol) {
  ++counts_[symbol];
  if (--until_update_ == 0) update();
}

void LazBit::update() {
  total_ += cycle_;
  if (total_ > 1U << kBits) {
    total_ = (total_ + 1) / 2;
    zeros_ = (zeros_ + 1) / 2;
    if (zeros_ == total_) ++total_;
  }
  const std::uint32_t scale = 0x80000000U / total_;
  start_of_one_ = (zeros_ * scale) >> (31 - kBits);
  cycle_ = std::min(5 * cycle_ / 4, std::uint32_t{64});
  until_update_ = cycle_;
}

void LazBit::count(std::uint32_t bit) {
  if (bit == 0) ++zeros_;
  if (--until_update_ == 0) update();
}

LazIntegerModels::LazIntegerModels()
    : sizes{LazSymbols(kErrorBits + 1), LazSymbols(kErrorBits + 1)} {
  for (std::uint32_t bits = 1; bits < kErrorBits; ++bits) {
    errors.emplace_back(std::size_t{1} << std::min(bits, kModelledBits));
  }
}

LazIntegers::LazIntegers(std::span<const std::byte> bytes) : bytes_(bytes) {
  for (int i = 0; i < 4; ++i) value_ = value_ << 8 | takeByte();
}

std::size_t LazIntegers::decode(LazSymbols& symbols) {
  const std::vector<std::uint32_t>& starts = symbols.starts();
  const std::uint32_t whole = length_;
  const std::uint32_t unit = whole >> LazSymbols::kBits;
  // The last symbol that does not start behind the value.
  const auto it = std::upper_bound(
      starts.begin() + 1, starts.end(), value_,
      [&](std::uint32_t value, std::uint32_t start) { return value < start * unit; });
  const auto symbol = static_cast<std::size_t>(it - starts.begin()) - 1;
  const std::uint32_t begin = starts[symbol] * unit;
  const std::uint32_t end = it == starts.end() ? whole : *it * unit;
  value_ -= begin;
  length_ = end - begin;
  renormalise();
  symbols.count(symbol);
  return symbol;
}

std::uint32_t LazIntegers::decode(LazBit& model) {
  const std::uint32_t split = model.startOfOne() * (length_ >> LazBit::kBits);
  const std::uint32_t bit = value_ >= split ? 1 : 0;
  if (bit == 0) {
    length_ = split;
  } else {
    value_ -= split;
    length_ -= split;
  }
  renormalise();
  model.count(bit);
  return bit;
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
  if (count > kMostBits) {
    const std::uint32_t lower = decodeBits(kLowerBits);
    return decodeBits(count - kLowerBits) << kLowerBits | lower;
  }
  length_ >>= count;
  const std::uint32_t bits = value_ / length_;
  value_ -= bits * length_;
  renormalise();
  return bits;
}

std::uint32_t LazIntegers::next(std::uint32_t predicted, std::size_t stream) {
  const auto size = static_cast<std::uint32_t>(decode(models_.sizes[stream]));
  if (size == 0) return predicted + decode(models_.small_error);
  if (size == kErrorBits) return predicted + 0x80000000U;  // the least integer, and it alone
  auto error = static_cast<std::uint32_t>(decode(models_.errors[size - 1]));
  if (size > kModelledBits) {
    const std::uint32_t lower_bits = size - kModelledBits;
    error = error << lower_bits | decodeBits(lower_bits);
  }
  // Of 2^size errors the upper half are positive and begin at 2^(size-1) + 1, the lower half are
  // negative and end at -2^(size-1).
  const std::uint32_t half = 1U << (size - 1);
  return predicted + (error >= half ? error + 1 : error - ((1U << size) - 1));
}

void LazIntegersWriter::moveBase(std::uint32_t by) {
  const std::uint32_t before = base_;
  base_ += by;
  if (base_ >= before) return;
  // The carry goes on to the bytes that were put down already.
  std::size_t i = bytes_.size();
  while (i > 0 && bytes_[i - 1] == std::byte{0xFF}) bytes_[--i] = std::byte{0};
  if (i > 0) bytes_[i - 1] = static_cast<std::byte>(std::to_integer<unsigned>(bytes_[i - 1]) + 1);
}

void LazIntegersWriter::renormalise() {
  while (length_ < kShortestInterval) {
    bytes_.push_back(static_cast<std::byte>(base_ >> 24));
    base_ <<= 8;
    length_ <<= 8;
  }
}

void LazIntegersWriter::encode(LazSymbols& symbols, std::size_t symbol) {
  const std::vector<std::uint32_t>& starts = symbols.starts();
  const std::uint32_t unit = length_ >> LazSymbols::kBits;
  const std::uint32_t begin = starts[symbol] * unit;
  const std::uint32_t end = symbol + 1 == starts.size() ? length_ : starts[symbol + 1] * unit;
  moveBase(begin);
  length_ = end - begin;
  renormalise();
  symbols.count(symbol);
}

void LazIntegersWriter::encode(LazBit& model, std::uint32_t bit) {
  const std::uint32_t split = model.startOfOne() * (length_ >> LazBit::kBits);
  if (bit == 0) {
    length_ = split;
  } else {
    moveBase(split);
    length_ -= split;
  }
  renormalise();
  model.count(bit);
}

void LazIntegersWriter::encodeBits(std::uint32_t bits, std::uint32_t count) {
  if (count > kMostBits) {
    encodeBits(bits & ((1U << kLowerBits) - 1), kLowerBits);
    encodeBits(bits >> kLowerBits, count - kLowerBits);
    return;
  }
  length_ >>= count;
  moveBase(bits * length_);
  renormalise();
}

void LazIntegersWriter::put(std::uint32_t value, std::uint32_t predicted, std::size_t stream) {
  const std::uint32_t difference = value - predicted;
  const bool positive = difference != 0 && difference < 0x80000000U;
  const auto size =
      static_cast<std::uint32_t>(std::bit_width(positive ? difference - 1 : 0U - difference));
  encode(models_.sizes[stream], size);
  if (size == 0) return encode(models_.small_error, difference);
  if (size == kErrorBits) return;
  const std::uint32_t error = positive ? difference - 1 : difference + ((1U << size) - 1);
  const std::uint32_t lower_bits = size > kModelledBits ? size - kModelledBits : 0;
  encode(models_.errors[size - 1], error >> lower_bits);
  if (lower_bits > 0) encodeBits(error & ((1U << lower_bits) - 1), lower_bits);
}

std::vector<std::byte> LazIntegersWriter::finish() {
  // Bytes enough that whatever follows them lies within the interval.
  const bool wide = length_ > 2 * kShortestInterval;
  moveBase(wide ? kShortestInterval : kShortestInterval >> 1);
  length_ = wide ? kShortestInterval >> 1 : kShortestInterval >> 9;
  renormalise();
  bytes_.resize(bytes_.size() + (wide ? 3 : 2));
  return std::move(bytes_);
}

}  // namespace agricolmap::io
