// Pieces of a file, made on all cores and written in their order meanwhile.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"

namespace agricolmap::io {

/// Calls `make(i, piece)` for i in [0, count) side by side and `write(piece)` in order, one at a
/// time, while the pieces behind it are made. `Piece` is used again: `make` must clear it. Two
/// batches of `together` pieces are in memory.
template <typename Piece, typename Make, typename Write>
void writeBehind(std::size_t count, std::size_t together, const Make& make, const Write& write) {
  std::array<std::vector<Piece>, 2> batches;
  for (auto& batch : batches) batch.resize(std::min(together, count));
  std::size_t waiting = 0;  // pieces of the batch before, not yet written
  for (std::size_t begin = 0; begin < count || waiting > 0; begin += together) {
    const std::size_t fresh = begin < count ? std::min(together, count - begin) : 0;
    parallelFor(1 + fresh, [&](std::size_t i) {
      if (i > 0) return make(begin + i - 1, batches[0][i - 1]);
      for (std::size_t k = 0; k < waiting; ++k) {
        throwIfInterrupted();
        write(batches[1][k]);
      }
    });
    std::swap(batches[0], batches[1]);
    waiting = fresh;
  }
}

}  // namespace agricolmap::io
