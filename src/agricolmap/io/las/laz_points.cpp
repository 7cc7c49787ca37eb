// LAZ by LASzip. It is handed one chunk at a time, as a file of that chunk alone with a header of
// our own: so every thread has a reader of its own, chunks of any size are found alike, and what a
// file claims of itself reaches LASzip only after it was held against the file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <istream>
#include <limits>
#include <streambuf>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/las/las_points.hpp"
#include "agricolmap/io/las/laszip_library.hpp"
#include "agricolmap/io/las/laz_chunks.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kHeader = 227;
constexpr std::size_t kRecordHeader = 54;
constexpr std::size_t kPointer = 8;
constexpr std::size_t kChunkSize = 12;  ///< where the record has it
/// Points that a byte of a real cloud holds, at most.
constexpr std::size_t kRealPerByte = 20;
/// Records handed over at a time.
constexpr std::size_t kBlock = 512;

/// Two pieces of memory as one file.
class TwoPieces : public std::streambuf {
 public:
  TwoPieces(std::span<const std::byte> head, std::span<const std::byte> rest)
      : head_(head), rest_(rest) {
    show(head_, 0, 0);
  }
  /// Bytes that were not read yet.
  std::size_t left() const { return head_.size() + rest_.size() - position(); }

 protected:
  int_type underflow() override {
    if (begin_ != 0 || rest_.empty()) return traits_type::eof();
    show(rest_, head_.size(), 0);
    return traits_type::to_int_type(*gptr());
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const auto end = static_cast<off_type>(head_.size() + rest_.size());
    if (from == std::ios_base::cur) offset += static_cast<off_type>(position());
    if (from == std::ios_base::end) offset += end;
    if (offset < 0 || offset > end) return pos_type(off_type(-1));
    const auto to = static_cast<std::size_t>(offset);
    if (to < head_.size()) {
      show(head_, 0, to);
    } else {
      show(rest_, head_.size(), to - head_.size());
    }
    return pos_type(offset);
  }
  pos_type seekpos(pos_type to, std::ios_base::openmode which) override {
    return seekoff(off_type(to), std::ios_base::beg, which);
  }

 private:
  std::size_t position() const { return begin_ + static_cast<std::size_t>(gptr() - eback()); }
  void show(std::span<const std::byte> piece, std::size_t begin, std::size_t at) {
    begin_ = begin;
    // The buffer of a stream that is only read from is never written to.
    auto* const first = const_cast<char*>(reinterpret_cast<const char*>(piece.data()));
    setg(first, first + at, first + piece.size());
  }
  std::span<const std::byte> head_;
  std::span<const std::byte> rest_;
  std::size_t begin_ = 0;  ///< position of the piece that is shown
};

/// LASzip's reader, closed and freed.
class Reader {
 public:
  Reader(const LaszipLibrary& library, std::istream& stream, LasWanted wanted) : lib_(library) {
    if (lib_.create(&reader_) != 0) throw Error(ErrorKind::kInternal, "LASzip cannot be used");
    try {
      choose(wanted);
      open(stream);
    } catch (...) {
      lib_.destroy(reader_);
      throw;
    }
  }
  ~Reader() {
    lib_.close_reader(reader_);
    lib_.destroy(reader_);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  /// False when the bytes are none that a compressor writes.
  bool next() { return lib_.read_point(reader_) == 0; }
  const laszip_point& point() const { return *point_; }

 private:
  void choose(LasWanted wanted) {
    laszip_U32 parts = laszip_DECOMPRESS_SELECTIVE_ALL;
    if (wanted != LasWanted::kAll) {
      parts = laszip_DECOMPRESS_SELECTIVE_CHANNEL_RETURNS_XY | laszip_DECOMPRESS_SELECTIVE_Z |
              laszip_DECOMPRESS_SELECTIVE_FLAGS;
    }
    if (wanted == LasWanted::kPlaceColours) parts |= laszip_DECOMPRESS_SELECTIVE_RGB;
    lib_.decompress_selective(reader_, parts);
  }
  void open(std::istream& stream) {
    laszip_BOOL compressed = 0;
    if (lib_.open_reader_stream(reader_, stream, &compressed) != 0 ||
        lib_.get_point_pointer(reader_, &point_) != 0) {
      laszip_CHAR* text = nullptr;
      lib_.get_error(reader_, &text);
      throw InputError(text == nullptr ? "LASzip cannot read it" : text);
    }
  }
  const LaszipLibrary& lib_;
  laszip_POINTER reader_ = nullptr;
  laszip_point* point_ = nullptr;
};

/// Colours, wave packet and extra bytes.
void storeRest(const laszip_point& point, const LasLayout& layout, std::byte* to) {
  if (layout.gps_time) storeLe(to + *layout.gps_time, point.gps_time);
  if (layout.nir) storeLe(to + *layout.nir, point.rgb[3]);
  if (layout.wave) std::memcpy(to + *layout.wave, point.wave_packet, sizeof(point.wave_packet));
  if (layout.extraBytes() > 0) {
    std::memcpy(to + layout.base, point.extra_bytes, layout.extraBytes());
  }
}

/// LASzip's point as the record that it was.
void storeRecord(const laszip_point& point, const LasLayout& layout, bool all, std::byte* to) {
  storeLe(to, point.X);
  storeLe(to + 4, point.Y);
  storeLe(to + 8, point.Z);
  storeLe(to + 12, point.intensity);
  const auto byte = [&](std::size_t at, unsigned value) { to[at] = static_cast<std::byte>(value); };
  const unsigned scan = point.scan_direction_flag | point.edge_of_flight_line << 1;
  if (layout.extended) {
    byte(14, point.extended_return_number | point.extended_number_of_returns << 4);
    byte(15, point.extended_classification_flags | point.extended_scanner_channel << 4 | scan << 6);
    byte(16, point.extended_classification);
    byte(17, point.user_data);
    storeLe(to + 18, point.extended_scan_angle);
    storeLe(to + 20, point.point_source_ID);
  } else {
    byte(14, point.return_number | point.number_of_returns << 3 | scan << 6);
    byte(15, point.classification | point.synthetic_flag << 5 | point.keypoint_flag << 6 |
                 point.withheld_flag << 7);
    byte(16, static_cast<std::uint8_t>(point.scan_angle_rank));
    byte(17, point.user_data);
    storeLe(to + 18, point.point_source_ID);
  }
  if (layout.rgb) std::memcpy(to + *layout.rgb, point.rgb, 3 * sizeof(point.rgb[0]));
  if (all) storeRest(point, layout, to);
}

class CompressedPoints : public LasPoints {
 public:
  CompressedPoints(const LaszipLibrary& library, std::span<const std::byte> bytes,
                   const LasHeader& header, const std::string& name)
      : lib_(library), layout_(header.layout), name_(name), table_(lazChunks(bytes, header, name)) {
    for (const LazChunk& chunk : table_.chunks) {
      if (chunk.points > std::numeric_limits<std::int32_t>::max()) {
        throw InputError(name + ": has more points in a chunk than can be read");
      }
    }
    // A chunk that claims more than real ones hold proves it before memory is set aside for it.
    parallelFor(table_.chunks.size(), [&](std::size_t i) {
      const LazChunk& chunk = table_.chunks[i];
      if (chunk.points / kRealPerByte <= chunk.bytes.size()) return;
      decode(i, LasWanted::kPlace, [](const std::byte* /*records*/, std::size_t /*count*/) {});
    });
  }

  std::size_t chunks() const override { return table_.chunks.size(); }
  std::size_t firstPoint(std::size_t chunk) const override {
    return static_cast<std::size_t>(table_.chunks[chunk].first);
  }

  void decode(std::size_t chunk, LasWanted wanted, const Sink& sink) const override {
    const LazChunk& from = table_.chunks[chunk];
    const std::vector<std::byte> head = headOf(from.points);
    TwoPieces pieces(head, from.bytes);
    std::istream stream(&pieces);
    Reader reader(lib_, stream, wanted);
    std::vector<std::byte> block(kBlock * layout_.length);
    for (std::size_t done = 0; done < from.points;) {
      throwIfInterrupted();
      const std::size_t count = std::min(kBlock, from.points - done);
      for (std::size_t i = 0; i < count; ++i) {
        if (!reader.next()) damaged(chunk);
        storeRecord(reader.point(), layout_, wanted == LasWanted::kAll, &block[i * layout_.length]);
      }
      sink(block.data(), count);
      done += count;
    }
    // The coder takes all bytes of a chunk that is whole.
    if (table_.chunked && pieces.left() != 0) damaged(chunk);
  }

 private:
  [[noreturn]] void damaged(std::size_t chunk) const {
    throw InputError(fmt::format("{}: damaged: chunk {} of {} (from point {} on) cannot be decoded",
                                 name_, chunk + 1, table_.chunks.size(),
                                 table_.chunks[chunk].first + 1));
  }

  /// What a file with these points alone has before them: header, the record of the compression,
  /// and a pointer that says that there is no chunk table.
  std::vector<std::byte> headOf(std::size_t points) const {
    const std::size_t end = kHeader + kRecordHeader + table_.record.size();
    std::array<std::byte, kHeader + kRecordHeader> head{};
    std::byte* const to = head.data();
    std::memcpy(to, "LASF", 4);
    to[24] = std::byte{1};
    to[25] = std::byte{2};
    storeLe(to + 94, static_cast<std::uint16_t>(kHeader));
    storeLe(to + 96, static_cast<std::uint32_t>(end));
    storeLe(to + 100, std::uint32_t{1});
    to[104] = static_cast<std::byte>(layout_.format | 0x80);
    storeLe(to + 105, static_cast<std::uint16_t>(layout_.length));
    storeLe(to + 107, static_cast<std::uint32_t>(points));
    for (std::size_t axis = 0; axis < 3; ++axis) storeLe(to + 131 + 8 * axis, 1.0);
    std::memcpy(to + kHeader + 2, kLazUser, std::strlen(kLazUser));
    storeLe(to + kHeader + 18, kLazRecord);
    storeLe(to + kHeader + 20, static_cast<std::uint16_t>(table_.record.size()));

    std::vector<std::byte> record = table_.record;
    std::array<std::byte, kPointer> pointer{};
    storeLe(pointer.data(), static_cast<std::int64_t>(end));
    if (table_.chunked) storeLe(&record[kChunkSize], static_cast<std::uint32_t>(points));
    std::vector<std::byte> file(head.begin(), head.end());
    file.insert(file.end(), record.begin(), record.end());
    if (table_.chunked) file.insert(file.end(), pointer.begin(), pointer.end());
    return file;
  }

  const LaszipLibrary& lib_;
  LasLayout layout_;
  std::string name_;
  LazChunks table_;
};

}  // namespace

std::unique_ptr<LasPoints> lazPoints(std::span<const std::byte> bytes, const LasHeader& header,
                                     const std::string& name) {
  const LaszipLibrary* library = laszip();
  if (library == nullptr) {
    throw InputError(
        fmt::format("{}: is compressed (LAZ), and {}give uncompressed LAS", name, kNoLaszip));
  }
  return std::make_unique<CompressedPoints>(*library, bytes, header, name);
}

}  // namespace agricolmap::io
