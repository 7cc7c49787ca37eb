#include "agricolmap/io/las/laz_chunk_table.hpp"

#include "agricolmap/io/las/las_layout.hpp"
#include "agricolmap/io/las/laz_integers.hpp"

namespace agricolmap::io {

std::vector<std::byte> lazChunkTable(std::span<const LazChunkSize> chunks, bool variable) {
  std::vector<std::byte> table(8);  // version 0, and how many
  storeLe(&table[4], static_cast<std::uint32_t>(chunks.size()));
  if (chunks.empty()) return table;
  LazIntegersWriter integers;
  LazChunkSize last;
  for (const LazChunkSize& chunk : chunks) {
    if (variable) integers.put(chunk.points, last.points, 0);
    integers.put(chunk.bytes, last.bytes, 1);
    last = chunk;
  }
  const std::vector<std::byte> coded = integers.finish();
  table.insert(table.end(), coded.begin(), coded.end());
  return table;
}

}  // namespace agricolmap::io
