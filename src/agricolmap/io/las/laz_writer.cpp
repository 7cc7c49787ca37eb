// LAZ by LASzip, which writes points alone: header and records are the LasWriter's.
#include <laszip/laszip_api.h>

#include <algorithm>
#include <exception>
#include <ostream>
#include <streambuf>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kRecordHeader = 54;

/// A file that goes on behind what was written to it. LASzip goes back once, for 8 bytes.
class SinkBuffer : public std::streambuf {
 public:
  explicit SinkBuffer(FileSink& sink)
      : sink_(sink), buffer_(std::size_t{1} << 20), at_(sink.size()) {}

  /// Why the file could not be written: LASzip takes what is thrown through it for an error of its
  /// own.
  void rethrow() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  void flush() {
    sink_.write(std::span<const std::byte>(buffer_).first(used_));
    used_ = 0;
  }

 protected:
  std::streamsize xsputn(const char* text, std::streamsize count) override {
    const auto bytes = std::as_bytes(std::span(text, static_cast<std::size_t>(count)));
    try {
      if (at_ == end()) {
        append(bytes);
      } else {
        flush();
        sink_.rewrite(at_, bytes);
      }
    } catch (...) {
      failure_ = std::current_exception();
      throw;
    }
    at_ += bytes.size();
    return count;
  }
  int_type overflow(int_type c) override {
    const char byte = traits_type::to_char_type(c);
    xsputn(&byte, 1);
    return c;
  }
  pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override {
    const std::size_t base = from == std::ios_base::beg   ? 0
                             : from == std::ios_base::cur ? at_
                                                          : end();
    at_ = static_cast<std::size_t>(static_cast<off_type>(base) + offset);
    return pos_type(static_cast<off_type>(at_));
  }
  pos_type seekpos(pos_type to, std::ios_base::openmode which) override {
    return seekoff(off_type(to), std::ios_base::beg, which);
  }

 private:
  std::size_t end() const { return sink_.size() + used_; }
  void append(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      if (used_ == buffer_.size()) flush();
      const std::size_t part = std::min(bytes.size(), buffer_.size() - used_);
      std::copy_n(bytes.begin(), part, buffer_.begin() + static_cast<std::ptrdiff_t>(used_));
      used_ += part;
      bytes = bytes.subspan(part);
    }
  }
  FileSink& sink_;
  std::vector<std::byte> buffer_;
  std::size_t used_ = 0;
  std::size_t at_;  ///< where the next byte goes
  std::exception_ptr failure_;
};

/// LASzip's writer, freed. Throws OutputError.
class Writer {
 public:
  explicit Writer(const LasLayout& layout) {
    if (laszip_create(&writer_) != 0) throw Error(ErrorKind::kInternal, "LASzip cannot be used");
    try {
      check(laszip_set_point_type_and_size(writer_, static_cast<laszip_U8>(layout.format),
                                           static_cast<laszip_U16>(layout.length)));
      check(laszip_request_native_extension(writer_, 1));
    } catch (...) {
      laszip_destroy(writer_);
      throw;
    }
  }
  ~Writer() { laszip_destroy(writer_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  laszip_POINTER get() const { return writer_; }
  void check(laszip_I32 failed) const {
    if (failed == 0) return;
    laszip_CHAR* text = nullptr;
    laszip_get_error(writer_, &text);
    throw OutputError(text == nullptr ? std::string("LASzip failed")
                                      : std::string("LASzip: ") + text);
  }

 private:
  laszip_POINTER writer_ = nullptr;
};

/// A record as LASzip's point; of the old fields of extended points it asks that they agree.
void loadRecord(const std::byte* from, const LasLayout& layout, laszip_point& point) {
  const auto byte = [&](std::size_t at) { return std::to_integer<unsigned>(from[at]); };
  point.X = loadLe<std::int32_t>(from);
  point.Y = loadLe<std::int32_t>(from + 4);
  point.Z = loadLe<std::int32_t>(from + 8);
  point.intensity = loadLe<std::uint16_t>(from + 12);
  const unsigned scan = layout.extended ? byte(15) >> 6 : byte(14) >> 6;
  point.scan_direction_flag = scan & 1U;
  point.edge_of_flight_line = scan >> 1 & 1U;
  const unsigned flags = layout.extended ? byte(15) & 0x07U : byte(15) >> 5;
  point.synthetic_flag = flags & 1U;
  point.keypoint_flag = flags >> 1 & 1U;
  point.withheld_flag = flags >> 2 & 1U;
  point.user_data = static_cast<laszip_U8>(byte(17));
  if (layout.extended) {
    point.extended_point_type = 1;
    point.extended_return_number = byte(14) & 0x0FU;
    point.extended_number_of_returns = byte(14) >> 4 & 0x0FU;
    point.extended_classification_flags = byte(15) & 0x0FU;
    point.extended_scanner_channel = byte(15) >> 4 & 0x03U;
    point.extended_classification = static_cast<laszip_U8>(byte(16));
    point.classification = byte(16) < 32 ? byte(16) & 0x1FU : 0U;
    point.extended_scan_angle = loadLe<std::int16_t>(from + 18);
    point.point_source_ID = loadLe<std::uint16_t>(from + 20);
  } else {
    point.return_number = byte(14) & 0x07U;
    point.number_of_returns = byte(14) >> 3 & 0x07U;
    point.classification = byte(15) & 0x1FU;
    point.scan_angle_rank = loadLe<std::int8_t>(from + 16);
    point.point_source_ID = loadLe<std::uint16_t>(from + 18);
  }
  if (layout.gps_time) point.gps_time = loadLe<double>(from + *layout.gps_time);
  if (layout.rgb) std::memcpy(point.rgb, from + *layout.rgb, 3 * sizeof(point.rgb[0]));
  if (layout.nir) point.rgb[3] = loadLe<std::uint16_t>(from + *layout.nir);
  if (layout.wave) std::memcpy(point.wave_packet, from + *layout.wave, sizeof(point.wave_packet));
  if (layout.extraBytes() > 0) {
    std::memcpy(point.extra_bytes, from + layout.base, layout.extraBytes());
  }
}

class Laz : public LasWriter::Encoder {
 public:
  Laz(FileSink& sink, const LasLayout& layout)
      : layout_(layout), buffer_(sink), stream_(&buffer_), writer_(layout) {
    stream_.exceptions(std::ios::badbit);  // what is thrown goes on to LASzip
    check(laszip_open_writer_stream(writer_.get(), stream_, 1, 1));
    check(laszip_get_point_pointer(writer_.get(), &point_));
  }
  void write(const std::byte* records, std::size_t count) override {
    for (std::size_t i = 0; i < count; ++i) {
      loadRecord(records + i * layout_.length, layout_, *point_);
      check(laszip_write_point(writer_.get()));
    }
  }
  void close() override {
    check(laszip_close_writer(writer_.get()));
    buffer_.flush();
  }

 private:
  void check(laszip_I32 failed) const {
    if (failed != 0) buffer_.rethrow();
    writer_.check(failed);
  }

  LasLayout layout_;
  SinkBuffer buffer_;
  std::ostream stream_;
  Writer writer_;
  laszip_point* point_ = nullptr;
};

}  // namespace

std::vector<std::byte> lazRecord(const LasLayout& layout) {
  const Writer writer(layout);
  laszip_U8* bytes = nullptr;
  laszip_U32 size = 0;
  writer.check(laszip_create_laszip_vlr(writer.get(), &bytes, &size));
  const auto all = std::as_bytes(std::span(bytes, size)).subspan(kRecordHeader);
  return {all.begin(), all.end()};
}

std::unique_ptr<LasWriter::Encoder> lazEncoder(FileSink& sink, const LasLayout& layout) {
  return std::make_unique<Laz>(sink, layout);
}

}  // namespace agricolmap::io
