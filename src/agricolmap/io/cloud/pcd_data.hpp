// The data behind the header of a PCD file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/io/cloud/pcd_header.hpp"

namespace agricolmap::io {

/// Bytes of all points, binary. Throws InputError when fewer are available.
std::uint64_t pcdBytes(const PcdHeader& header, std::uint64_t available, const std::string& name);

/// What binary_compressed data hold: field after field, each of all points. `rest` gets the number
/// of bytes that follow. Throws InputError when they are truncated or damaged.
std::vector<std::byte> decompressPcd(const PcdHeader& header, std::span<const std::byte> data,
                                     const std::string& name, std::size_t& rest);

}  // namespace agricolmap::io
