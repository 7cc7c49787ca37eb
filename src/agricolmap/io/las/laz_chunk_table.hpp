// The table at the end of a LAZ file's points: how large its chunks are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace agricolmap::io {

struct LazChunkSize {
  std::uint32_t points = 0;
  std::uint32_t bytes = 0;
};

/// The table's bytes. `variable`: with the numbers of points, which else are all the same.
std::vector<std::byte> lazChunkTable(std::span<const LazChunkSize> chunks, bool variable);

}  // namespace agricolmap::io
