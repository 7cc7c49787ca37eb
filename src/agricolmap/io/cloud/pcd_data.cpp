#include "agricolmap/io/cloud/pcd_data.hpp"

#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

/// LZF repeats at most 264 bytes from 3.
constexpr std::uint64_t kMaxExpansion = 88;

}  // namespace

std::uint64_t pcdBytes(const PcdHeader& header, std::uint64_t available, const std::string& name) {
  const std::size_t each = std::max<std::size_t>(header.pointBytes(), 1);  // x, y, z at least
  if (header.points > available / each) {
    throw InputError(fmt::format(
        "{}: truncated: the header announces {} points of {} bytes, but only {} bytes follow ({} "
        "points)",
        name, header.points, each, available, available / each));
  }
  return header.points * each;
}

std::vector<std::byte> decompressPcd(const PcdHeader& header, std::span<const std::byte> data,
                                     const std::string& name, std::size_t& rest) {
  std::array<std::uint32_t, 2> sizes{};
  if (data.size() < sizeof(sizes)) {
    throw InputError(fmt::format("{}: truncated: no compressed data follow the header", name));
  }
  std::memcpy(sizes.data(), data.data(), sizeof(sizes));
  data = data.subspan(sizeof(sizes));
  const auto [compressed, plain] = sizes;
  if (compressed > data.size()) {
    throw InputError(fmt::format("{}: truncated: {} bytes of compressed data announced, {} follow",
                                 name, compressed, data.size()));
  }
  // Checked before anything is allocated on the file's word.
  if (plain > kMaxExpansion * compressed) {
    throw InputError(
        fmt::format("{}: damaged: {} bytes cannot expand to {}", name, compressed, plain));
  }
  if (pcdBytes(header, plain, name) != plain) {
    throw InputError(fmt::format("{}: {} bytes of data for {} points of {} bytes", name, plain,
                                 header.points, header.pointBytes()));
  }
  rest = data.size() - compressed;
  std::vector<std::byte> out(plain);
  if (lzf_decompress(data.data(), compressed, out.data(), plain) != plain) {
    throw InputError(fmt::format("{}: the compressed data are damaged", name));
  }
  return out;
}

}  // namespace agricolmap::io
