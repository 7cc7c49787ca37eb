// How the points of a LAZ file are cut into chunks that are compressed each for itself: what its
// record "laszip encoded" and its chunk table say, held against the file.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/io/las/las_header.hpp"

namespace agricolmap::io {

/// The number of the record that describes the compression, and the user that it belongs to.
inline constexpr std::uint16_t kLazRecord = 22204;
inline constexpr const char* kLazUser = "laszip encoded";

struct LazChunk {
  std::span<const std::byte> bytes;  ///< within the file
  std::uint64_t first = 0;           ///< index of its first point
  std::size_t points = 0;
};

struct LazChunks {
  std::vector<LazChunk> chunks;  ///< in the order of the file; all points of the header
  /// The record "laszip encoded", whose description of the points fits their format.
  std::vector<std::byte> record;
  bool chunked = false;  ///< the compressor works in chunks; else there is one chunk without end
};

/// Throws InputError naming `name` and the fault: no description of the compression, one that does
/// not fit the points, a chunk table that is missing or leads beyond the file, layers of a chunk
/// that are larger than it.
LazChunks lazChunks(std::span<const std::byte> bytes, const LasHeader& header,
                    const std::string& name);

}  // namespace agricolmap::io
