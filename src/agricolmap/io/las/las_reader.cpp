#include "agricolmap/io/las/las_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/las/las_marks.hpp"
#include "agricolmap/io/las/las_points.hpp"

namespace agricolmap::io {
namespace {

class LasSource : public PointSource {
 public:
  LasSource(LasHeader header, std::unique_ptr<LasPoints> points, const ReadOptions& options)
      : header_(std::move(header)),
        points_(std::move(points)),
        colours_(options.colours && header_.layout.rgb),
        marks_(options.marks) {}

  std::size_t points() const override { return static_cast<std::size_t>(header_.points); }
  std::size_t chunks() const override { return points_->chunks(); }
  std::size_t firstPoint(std::size_t chunk) const override { return points_->firstPoint(chunk); }
  ColourKind colourKind() const override {
    return colours_ ? ColourKind::kWideInteger : ColourKind::kNone;
  }
  bool floatCoordinates() const override { return false; }
  bool dear() const override { return header_.compressed; }
  bool marked() const override { return marks_; }

  void decode(std::size_t chunk, const Sink& sink) const override {
    PointBlock block;
    const LasWanted wanted = marks_     ? LasWanted::kAll
                             : colours_ ? LasWanted::kPlaceColours
                                        : LasWanted::kPlace;
    points_->decode(chunk, wanted, [&](const std::byte* records, std::size_t count) {
      for (std::size_t done = 0; done < count;) {
        const std::size_t some = std::min(count - done, PointBlock::kCapacity - block.count);
        take(records + done * header_.layout.length, some, block);
        done += some;
        if (block.count < PointBlock::kCapacity) continue;
        sink(block);
        block.count = 0;
        block.withheld = 0;
      }
    });
    if (block.count > 0 || block.withheld > 0) sink(block);
  }

 private:
  /// Adds `count` records for which there is room.
  void take(const std::byte* records, std::size_t count, PointBlock& block) const {
    const std::size_t length = header_.layout.length;
    std::size_t withheld = 0;
    for (std::size_t i = 0; i < count; ++i) {
      withheld += header_.layout.withheld(records + i * length) ? 1 : 0;
    }
    if (withheld == 0) {
      load(records, count, block);
      return;
    }
    block.withheld += withheld;
    for (std::size_t i = 0; i < count; ++i) {
      const std::byte* const record = records + i * length;
      if (!header_.layout.withheld(record)) load(record, 1, block);
    }
  }

  /// Channel after channel: so the compiler keeps what is the same for all in registers.
  void load(const std::byte* records, std::size_t count, PointBlock& block) const {
    const std::size_t length = header_.layout.length;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double scale = header_.scale[static_cast<Eigen::Index>(axis)];
      const double offset = header_.offset[static_cast<Eigen::Index>(axis)];
      const std::byte* from = records + axis * sizeof(std::int32_t);
      double* const to = &block.xyz[axis][block.count];
      for (std::size_t i = 0; i < count; ++i, from += length) {
        to[i] = scale * loadLe<std::int32_t>(from) + offset;
      }
    }
    for (std::size_t c = 0; colours_ && c < block.wide.size(); ++c) {
      const std::byte* from = records + *header_.layout.rgb + c * sizeof(std::uint16_t);
      float* const to = &block.wide[c][block.count];
      for (std::size_t i = 0; i < count; ++i, from += length) to[i] = loadLe<std::uint16_t>(from);
    }
    for (std::size_t i = 0; marks_ && i < count; ++i) {
      block.marks[block.count + i] = marksOf(records + i * length, header_.layout);
    }
    block.count += count;
  }

  LasHeader header_;
  std::unique_ptr<LasPoints> points_;
  bool colours_;
  bool marks_;
};

/// The names that the record "extra bytes" gives to what it describes.
std::string extraNames(const LasHeader& header) {
  constexpr std::uint16_t kExtraBytes = 4;
  constexpr std::size_t kDescription = 192;
  const LasRecord* const record = header.find("LASF_Spec", kExtraBytes);
  std::string names;
  if (record == nullptr) return names;
  for (std::size_t at = 0; at + kDescription <= record->data.size(); at += kDescription) {
    names += names.empty() ? "" : ", ";
    for (std::size_t i = 4; i < 36 && record->data[at + i] != std::byte{0}; ++i) {
      const auto c = std::to_integer<char>(record->data[at + i]);
      names += c >= ' ' && c <= '~' ? c : '?';
    }
  }
  return names;
}

/// Whether the file says that x and y are degrees: by a GeoTIFF key, or by how its WKT begins.
bool saysDegrees(const LasHeader& header) {
  constexpr std::uint16_t kModelType = 1024;
  constexpr std::uint16_t kGeographic = 2;
  constexpr std::size_t kKey = 8;
  if (const LasRecord* const wkt = header.find("LASF_Projection", 2112)) {
    const std::string_view text(reinterpret_cast<const char*>(wkt->data.data()), wkt->data.size());
    return text.starts_with("GEOG");
  }
  const LasRecord* const keys = header.find("LASF_Projection", 34735);
  if (keys == nullptr) return false;
  for (std::size_t at = kKey; at + kKey <= keys->data.size(); at += kKey) {
    if (loadLe<std::uint16_t>(&keys->data[at]) == kModelType) {
      return loadLe<std::uint16_t>(&keys->data[at + 6]) == kGeographic;
    }
  }
  return false;
}

}  // namespace

PointFile openLas(const MappedFile& file, const std::string& name, const ReadOptions& options) {
  LasHeader header = parseLasHeader(file.bytes(), name);
  auto points = lasPoints(file.bytes(), header, name);
  PointFile opened;
  opened.name = name;
  opened.file = &file;
  opened.fields = lasFields(header.layout);
  const std::string extra = extraNames(header);
  if (!extra.empty()) opened.fields += fmt::format(" ({})", extra);
  if (options.map == nullptr && saysDegrees(header)) {
    opened.notes.push_back(
        fmt::format("{}: its coordinates are degrees, and taken as metres here", name));
  }
  opened.warnings = header.warnings;
  opened.black_is_none = true;
  opened.source = std::make_unique<LasSource>(std::move(header), std::move(points), options);
  return opened;
}

}  // namespace agricolmap::io
