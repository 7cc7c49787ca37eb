// The arithmetic coder by which LAZ stores the table of its chunks: the decoder alone, and of its
// models only what that table needs.
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

/// Decodes integers from bytes. Reading beyond their end gives zeros and is noted.
class LazIntegers {
 public:
  explicit LazIntegers(std::span<const std::byte> bytes);

  /// The next integer, of which `predicted` was expected. Both streams, 0 and 1, have statistics of
  /// their own for how large the error is.
  std::uint32_t next(std::uint32_t predicted, std::size_t stream);
  bool beyondEnd() const { return beyond_end_; }

 private:
  /// How often each symbol came, so how much of the interval it gets.
  class Symbols {
   public:
    explicit Symbols(std::size_t count);
    std::size_t decode(LazIntegers& decoder);

   private:
    void update();
    std::vector<std::uint32_t> counts_;
    std::vector<std::uint32_t> starts_;  ///< cumulative, in 2^-15
    std::uint32_t total_ = 0;
    std::uint32_t cycle_ = 0;
    std::uint32_t until_update_ = 0;
  };
  class Bit {
   public:
    std::uint32_t decode(LazIntegers& decoder);

   private:
    void update();
    std::uint32_t zeros_ = 1;
    std::uint32_t total_ = 2;
    std::uint32_t start_of_one_ = 1U << 12;  ///< in 2^-13
    std::uint32_t cycle_ = 4;
    std::uint32_t until_update_ = 4;
  };

  std::uint32_t decodeBits(std::uint32_t count);
  void renormalise();
  std::uint32_t takeByte();

  std::span<const std::byte> bytes_;
  std::size_t next_ = 0;
  bool beyond_end_ = false;
  std::uint32_t value_ = 0;
  std::uint32_t length_ = 0xFFFFFFFFU;
  std::array<Symbols, 2> sizes_;  ///< of the error, in bits; one per stream
  std::vector<Symbols> errors_;   ///< upper bits of errors of 1, 2, … bits
  Bit small_error_;               ///< an error of 0 or 1
};

}  // namespace agricolmap::io
