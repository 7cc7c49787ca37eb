// Where the records of LAS keep what: the eleven point data record formats of LAS 1.0 to 1.5.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

namespace agricolmap::io {

static_assert(std::endian::native == std::endian::little, "written for little-endian machines");

/// A value of a file that is little-endian and not aligned.
template <typename T>
T loadLe(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

template <typename T>
void storeLe(std::byte* to, T value) {
  std::memcpy(to, &value, sizeof(T));
}

inline constexpr int kLasFormats = 11;

/// Byte offsets within a point's record. X, Y and Z are 32-bit integers at 0, 4 and 8, the
/// intensity follows at 12 in all formats.
struct LasLayout {
  int format = 0;          ///< 0 to 10
  std::size_t length = 0;  ///< of a record, extra bytes included
  std::size_t base = 0;    ///< what the format itself takes of it
  bool extended = false;   ///< formats 6 to 10: flags and returns in other places
  std::optional<std::size_t> gps_time;
  std::optional<std::size_t> rgb;   ///< three 16-bit integers
  std::optional<std::size_t> nir;   ///< one
  std::optional<std::size_t> wave;  ///< 29 bytes

  std::size_t extraBytes() const { return length - base; }
  /// Whether the point of a record is marked as one that shall not be used.
  bool withheld(const std::byte* record) const {
    constexpr std::size_t kFlags = 15;
    const auto flags = std::to_integer<unsigned>(record[kFlags]);
    return (flags & (extended ? 0x04U : 0x80U)) != 0;
  }
};

/// The layout of `format`, without extra bytes. The format must be one of the eleven.
LasLayout lasLayout(int format);

/// "x, y, z, intensity, …": what records hold, for messages. Extra bytes are counted.
std::string lasFields(const LasLayout& layout);

}  // namespace agricolmap::io
