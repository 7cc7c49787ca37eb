// LAZ by LASzip, which compresses one chunk at a time: all else of the file is the LasWriter's.
#include <sstream>
#include <string>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/las/las_writer.hpp"
#include "agricolmap/io/las/laszip_library.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kRecordHeader = 54;
constexpr std::size_t kPointer = 8;
constexpr std::size_t kChunkSize = 12;  ///< where LASzip's record has it
constexpr std::uint32_t kVariable = 0xFFFFFFFFU;

/// LASzip's writer, freed.
class Writer {
 public:
  explicit Writer(const LasLayout& layout) : lib_(writing()) {
    if (lib_.create(&writer_) != 0) throw Error(ErrorKind::kInternal, "LASzip cannot be used");
    try {
      check(lib_.set_point_type_and_size(writer_, static_cast<laszip_U8>(layout.format),
                                         static_cast<laszip_U16>(layout.length)));
      check(lib_.request_native_extension(writer_, 1));
    } catch (...) {
      lib_.destroy(writer_);
      throw;
    }
  }
  ~Writer() { lib_.destroy(writer_); }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  laszip_POINTER get() const { return writer_; }
  const LaszipLibrary& lib() const { return lib_; }
  void check(laszip_I32 failed) const {
    if (failed == 0) return;
    laszip_CHAR* text = nullptr;
    lib_.get_error(writer_, &text);
    throw OutputError(text == nullptr ? std::string("LASzip failed")
                                      : std::string("LASzip: ") + text);
  }

 private:
  static const LaszipLibrary& writing() {
    const LaszipLibrary* library = laszip();
    if (library == nullptr) {
      throw UsageError(std::string("LAZ and COPC cannot be written: ") + kNoLaszip + "write LAS");
    }
    return *library;
  }
  const LaszipLibrary& lib_;
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

}  // namespace

std::vector<std::byte> lazRecord(const LasLayout& layout, bool variable) {
  const Writer writer(layout);
  laszip_U8* bytes = nullptr;
  laszip_U32 size = 0;
  writer.check(writer.lib().create_laszip_vlr(writer.get(), &bytes, &size));
  const auto all = std::as_bytes(std::span(bytes, size)).subspan(kRecordHeader);
  std::vector<std::byte> record(all.begin(), all.end());
  if (variable) storeLe(&record.at(kChunkSize), kVariable);
  return record;
}

std::vector<std::byte> lazChunk(const std::byte* records, std::size_t count,
                                const LasLayout& layout) {
  std::ostringstream stream;
  const Writer writer(layout);
  writer.check(writer.lib().set_chunk_size(writer.get(), static_cast<laszip_U32>(count)));
  writer.check(writer.lib().open_writer_stream(writer.get(), stream, 1, 1));
  laszip_point* point = nullptr;
  writer.check(writer.lib().get_point_pointer(writer.get(), &point));
  for (std::size_t i = 0; i < count; ++i) {
    loadRecord(records + i * layout.length, layout, *point);
    writer.check(writer.lib().write_point(writer.get()));
  }
  writer.check(writer.lib().close_writer(writer.get()));
  // A file of this chunk alone: where its table of chunks is, the chunk, the table.
  const std::string file = std::move(stream).str();
  const auto bytes = std::as_bytes(std::span(file));
  const auto table = static_cast<std::size_t>(loadLe<std::int64_t>(bytes.data()));
  const auto chunk = bytes.subspan(kPointer, table - kPointer);
  return {chunk.begin(), chunk.end()};
}

}  // namespace agricolmap::io
