#include "agricolmap/io/las/laz_chunks.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/las/laz_integers.hpp"

namespace agricolmap::io {
namespace {

using Bytes = std::span<const std::byte>;

/// Kinds of compressors in the record.
enum : std::uint16_t { kPointwise = 1, kPointwiseChunked = 2, kLayeredChunked = 3 };
/// Kinds of the items that a point is made of.
enum : std::uint16_t {
  kBytes = 0,
  kPoint = 6,
  kTime = 7,
  kColour = 8,
  kWave = 9,
  kPoint14 = 10,
  kColour14 = 11,
  kColourNir14 = 12,
  kWave14 = 13,
  kBytes14 = 14,
};
constexpr std::uint32_t kVariableSize = 0xFFFFFFFFU;
constexpr std::size_t kRecordHead = 34;
constexpr std::size_t kItemBytes = 6;
/// Points that a byte can hold: equal ones take a hundredth of it, real ones several.
constexpr std::size_t kMostPerByte = 1000;

struct Item {
  std::uint16_t kind = 0;
  std::size_t size = 0;
  std::size_t layers = 0;  ///< that a layered chunk keeps of it
  bool operator==(const Item& other) const { return kind == other.kind && size == other.size; }
};

/// The items of which a point of this layout must be made.
std::vector<Item> itemsOf(const LasLayout& layout) {
  std::vector<Item> items;
  const std::size_t extra = layout.extraBytes();
  if (layout.extended) {
    items.push_back({kPoint14, 30, 9});
    if (layout.nir) {
      items.push_back({kColourNir14, 8, 2});
    } else if (layout.rgb) {
      items.push_back({kColour14, 6, 1});
    }
    if (layout.wave) items.push_back({kWave14, 29, 1});
    if (extra > 0) items.push_back({kBytes14, extra, extra});
    return items;
  }
  items.push_back({kPoint, 20, 0});
  if (layout.gps_time) items.push_back({kTime, 8, 0});
  if (layout.rgb) items.push_back({kColour, 6, 0});
  if (layout.wave) items.push_back({kWave, 29, 0});
  if (extra > 0) items.push_back({kBytes, extra, 0});
  return items;
}

class Table {
 public:
  Table(Bytes bytes, const LasHeader& header, const std::string& name)
      : bytes_(bytes), header_(header), name_(name) {}

  LazChunks read() {
    readRecord();
    if (chunks_.chunked) {
      readChunks();
    } else {
      chunks_.chunks.push_back(
          {bytes_.subspan(header_.points_begin), 0, static_cast<std::size_t>(header_.points)});
    }
    for (std::size_t i = 0; i < chunks_.chunks.size(); ++i) {
      checkRatio(i);
      if (compressor_ == kLayeredChunked) checkLayers(i);
    }
    return std::move(chunks_);
  }

 private:
  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(name_ + ": " + fmt::format(format, std::forward<Args>(args)...));
  }

  void readRecord() {
    const LasRecord* const record = header_.find(kLazUser, kLazRecord);
    if (record == nullptr) {
      fail("its points are compressed, but it does not say how: its record '{}' is missing",
           kLazUser);
    }
    const Bytes data = record->data;
    if (data.size() < kRecordHead) fail("damaged: its record '{}' is too short", kLazUser);
    compressor_ = loadLe<std::uint16_t>(data.data());
    // LASzip reads points of the extended formats by layers only, and crashes where it cannot.
    const bool known = header_.layout.extended
                           ? compressor_ == kLayeredChunked
                           : compressor_ == kPointwise || compressor_ == kPointwiseChunked;
    if (!known || loadLe<std::uint16_t>(data.data() + 2) != 0) {
      fail("is compressed in a way that is not known for points of format {} (compressor {})",
           header_.layout.format, compressor_);
    }
    chunks_.chunked = compressor_ != kPointwise;
    chunk_size_ = loadLe<std::uint32_t>(data.data() + 12);
    if (chunks_.chunked && chunk_size_ == 0) fail("damaged: its chunks have no points");
    const std::size_t count = loadLe<std::uint16_t>(data.data() + 32);
    const std::vector<Item> expected = itemsOf(header_.layout);
    bool fits = count == expected.size() && data.size() >= kRecordHead + count * kItemBytes;
    for (std::size_t i = 0; fits && i < count; ++i) {
      const std::byte* const item = data.data() + kRecordHead + i * kItemBytes;
      fits = Item{loadLe<std::uint16_t>(item), loadLe<std::uint16_t>(item + 2)} == expected[i];
    }
    if (!fits) {
      fail("damaged: what its record '{}' says of the points is not their format, {} with {} bytes",
           kLazUser, header_.layout.format, header_.layout.length);
    }
    const Bytes used = data.first(kRecordHead + count * kItemBytes);
    chunks_.record.assign(used.begin(), used.end());
  }

  void readChunks() {
    constexpr std::size_t kPointer = 8;
    const std::size_t begin = header_.points_begin + kPointer;
    if (bytes_.size() < begin) fail("truncated: it ends before its points");
    auto at = static_cast<std::uint64_t>(loadLe<std::int64_t>(&bytes_[header_.points_begin]));
    // Writers that cannot go back leave the place of the table at the very end.
    if (at == ~std::uint64_t{0}) at = loadLe<std::uint64_t>(&bytes_[bytes_.size() - kPointer]);
    if (at == begin - kPointer) {
      fail("its writer was interrupted: the table of its chunks is missing; write it again");
    }
    if (at < begin || at > bytes_.size() || bytes_.size() - at < 8) {
      fail("truncated: the table of its chunks is at byte {}, the file has {}", at, bytes_.size());
    }
    const std::size_t table = static_cast<std::size_t>(at);
    if (loadLe<std::uint32_t>(&bytes_[table]) != 0) {
      fail("damaged: there is no table of chunks at byte {}", table);
    }
    const std::size_t count = loadLe<std::uint32_t>(&bytes_[table + 4]);
    // A chunk keeps its first point as it is.
    if (count > (table - begin) / header_.layout.length) {
      fail("damaged: its {} bytes of points are no {} chunks", table - begin, count);
    }
    decodeTable(bytes_.subspan(begin, table - begin), bytes_.subspan(table + 8), count);
  }

  void decodeTable(Bytes points, Bytes table, std::size_t count) {
    const bool variable = chunk_size_ == kVariableSize;
    LazIntegers integers(table);
    std::uint32_t size = 0;
    std::uint32_t in_chunk = 0;
    std::size_t from = 0;
    std::uint64_t first = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (variable) in_chunk = integers.next(in_chunk, 0);
      size = integers.next(size, 1);
      const std::uint64_t left = header_.points - first;
      const std::uint64_t announced = variable ? in_chunk : chunk_size_;
      if (size < header_.layout.length || size > points.size() - from || integers.beyondEnd() ||
          announced == 0 || (variable && announced > left)) {
        fail("damaged: chunk {} of {} is said to have {} bytes and {} points", i + 1, count, size,
             announced);
      }
      const std::uint64_t used = std::min(announced, left);
      if (used > 0) {
        chunks_.chunks.push_back(
            {points.subspan(from, size), first, static_cast<std::size_t>(used)});
      }
      from += size;
      first += used;
    }
    if (first < header_.points) {
      fail("truncated: the header announces {} points, its {} chunks have {}", header_.points,
           count, first);
    }
  }

  void checkRatio(std::size_t index) const {
    const LazChunk& chunk = chunks_.chunks[index];
    if (chunk.points / kMostPerByte > chunk.bytes.size()) {
      fail("damaged: chunk {} of {} is said to have {} points in {} bytes", index + 1,
           chunks_.chunks.size(), chunk.points, chunk.bytes.size());
    }
  }

  /// A layered chunk is its first point, how many points it has, the sizes of its layers, and
  /// these.
  void checkLayers(std::size_t index) const {
    const LazChunk& chunk = chunks_.chunks[index];
    std::size_t layers = 0;
    for (const Item& item : itemsOf(header_.layout)) layers += item.layers;
    const std::size_t head = header_.layout.length + 4 + 4 * layers;
    std::uint64_t sum = head;
    if (chunk.bytes.size() >= head) {
      const std::byte* const sizes = &chunk.bytes[header_.layout.length + 4];
      for (std::size_t i = 0; i < layers; ++i) sum += loadLe<std::uint32_t>(sizes + 4 * i);
    }
    if (sum > chunk.bytes.size()) {
      fail("damaged: the layers of chunk {} of {} take {} bytes, the chunk has {}", index + 1,
           chunks_.chunks.size(), sum, chunk.bytes.size());
    }
  }

  Bytes bytes_;
  const LasHeader& header_;
  const std::string& name_;
  std::uint16_t compressor_ = 0;
  std::uint32_t chunk_size_ = 0;
  LazChunks chunks_;
};

}  // namespace

LazChunks lazChunks(std::span<const std::byte> bytes, const LasHeader& header,
                    const std::string& name) {
  return Table(bytes, header, name).read();
}

}  // namespace agricolmap::io
