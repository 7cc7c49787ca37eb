// Stage describe (paper Sec. III-B): dense descriptors of a grid map, at several resolutions.
#pragma once

#include <cstdint>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/map/data_term.hpp"
#include "agricolmap/map/grid_map.hpp"
#include "agricolmap/paper/describe/aligned_vector.hpp"
#include "agricolmap/paper/describe/daisy.hpp"
#include "agricolmap/paper/describe/fpfh.hpp"

namespace agricolmap::paper {

/// What a cell without points is to the descriptors of others. None is ever described itself.
enum class EmptyCells {
  kMasked,  ///< nothing: means are over the cells that hold points; not in the paper
  kZero,    ///< Excess Green and height 0, as the paper's cells begin
};

struct DescribeOptions {
  map::DataTerm term = map::DataTerm::kExgHeight;
  EmptyCells empty = EmptyCells::kMasked;
  double max_memory = 4.0;  ///< that describing one map may take [GiB]
  DaisyOptions daisy;
  FpfhOptions fpfh;
};
void listOptions(OptionTable& table, DescribeOptions& options);

/// Descriptors of every cell, as bytes. A cell's `kStride` bytes are DAISY's 128 (daisy.hpp),
/// FPFH's 33 (fpfh.hpp) and 31 of padding, all zero where there is nothing to describe. The padding
/// makes a cell three whole cache lines, DAISY's two and FPFH's one.
struct DescriptorMap {
  static constexpr int kFpfhOffset = kDaisySize;
  static constexpr int kStride = 192;
  /// Bits 0–15 of `known`: DAISY's sample points that lie on known ground; bit 16: FPFH.
  static constexpr std::uint32_t kDaisyBits = 0xFFFF;
  static constexpr std::uint32_t kFpfhBit = 1U << 16;

  GridFrame frame;
  AlignedVector<std::uint8_t> bytes;
  std::vector<std::uint32_t> known;  ///< per cell

  /// True where the cell's own surroundings are known; single empty cells are bridged.
  bool describes(std::size_t cell) const { return (known[cell] & (1U | kFpfhBit)) != 0; }
  std::size_t index(int row, int col) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.cols) +
           static_cast<std::size_t>(col);
  }
  const std::uint8_t* daisy(std::size_t cell) const { return bytes.data() + cell * kStride; }
  /// Asks for a cell that will be read soon.
  void prefetch(std::size_t cell) const {
    for (int line = 0; line < kStride; line += 64) __builtin_prefetch(daisy(cell) + line);
  }
  const std::uint8_t* fpfh(std::size_t cell) const { return daisy(cell) + kFpfhOffset; }
};

/// Most memory that describing so many cells takes [bytes]: the finest level's descriptors and the
/// layers that they are made of, which are given back before the next level.
double describingBytes(double cells);

/// Descriptors of the part of `map` in `window` (levelled frame [m]) at `levels` resolutions,
/// finest first, each with half the resolution of the one before. Empty when the window misses the
/// map. Throws UsageError, before it allocates anything, where that would take more memory than
/// allowed.
std::vector<DescriptorMap> describeMap(const map::GridMap& map, const map::Box2& window, int levels,
                                       const DescribeOptions& options);

}  // namespace agricolmap::paper
