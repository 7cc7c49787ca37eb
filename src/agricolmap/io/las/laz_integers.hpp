// The arithmetic coder by which LAZ stores the table of its chunks, and of its models only what
// that table needs.
//
// A. Said, Introduction to Arithmetic Coding: Theory and Practice, HPL-2004-76; M. Isenburg,
// LASzip: lossless compression of lidar data, 2013, for how integers are predicted and their errors
// coded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace agricolmap::io {

/// How often each symbol came, so how much of the interval it gets.
class LazSymbols {
 public:
  static constexpr std::uint32_t kBits = 15;  ///< starts are in 2^-15

  explicit LazSymbols(std::size_t count);
  const std::vector<std::uint32_t>& starts() const { return starts_; }
  void count(std::size_t symbol);

 private:
  void update();
  std::vector<std::uint32_t> counts_;
  std::vector<std::uint32_t> starts_;  ///< cumulative
  std::uint32_t total_ = 0;
  std::uint32_t cycle_ = 0;
  std::uint32_t until_update_ = 0;
};

/// The same of two symbols.
class LazBit {
 public:
  static constexpr std::uint32_t kBits = 13;

  std::uint32_t startOfOne() const { return start_of_one_; }
  void count(std::uint32_t bit);

 private:
  void update();
  std::uint32_t zeros_ = 1;
  std::uint32_t total_ = 2;
  std::uint32_t start_of_one_ = 1U << (kBits - 1);
  std::uint32_t cycle_ = 4;
  std::uint32_t until_update_ = 4;
};

/// What is known of the integers so far. Both streams, 0 and 1, have statistics of their own for
/// how large the error of a prediction is.
struct LazIntegerModels {
  LazIntegerModels();
  std::array<LazSymbols, 2> sizes;  ///< of the error, in bits; one per stream
  std::vector<LazSymbols> errors;   ///< upper bits of errors of 1, 2, … bits
  LazBit small_error;               ///< an error of 0 or 1
};

/// Decodes integers from bytes. Reading beyond their end gives zeros and is noted.
class LazIntegers {
 public:
  explicit LazIntegers(std::span<const std::byte> bytes);

  /// The next integer, of which `predicted` was expected.
  std::uint32_t next(std::uint32_t predicted, std::size_t stream);
  bool beyondEnd() const { return beyond_end_; }

 private:
  std::size_t decode(LazSymbols& symbols);
  std::uint32_t decode(LazBit& model);
  std::uint32_t decodeBits(std::uint32_t count);
  void renormalise();
  std::uint32_t takeByte();

  std::span<const std::byte> bytes_;
  std::size_t next_ = 0;
  bool beyond_end_ = false;
  std::uint32_t value_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  LazIntegerModels models_;
};

/// Encodes integers as LazIntegers decodes them.
class LazIntegersWriter {
 public:
  void put(std::uint32_t value, std::uint32_t predicted, std::size_t stream);
  /// All bytes; no integer follows.
  std::vector<std::byte> finish();

 private:
  void encode(LazSymbols& symbols, std::size_t symbol);
  void encode(LazBit& model, std::uint32_t bit);
  void encodeBits(std::uint32_t bits, std::uint32_t count);
  void moveBase(std::uint32_t by);
  void renormalise();

  std::vector<std::byte> bytes_;
  std::uint32_t base_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  LazIntegerModels models_;
};

}  // namespace agricolmap::io
