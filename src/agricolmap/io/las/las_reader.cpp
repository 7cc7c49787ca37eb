#include "agricolmap/io/las/las_reader.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/las/las_points.hpp"

namespace agricolmap::io {
namespace {

class LasSource : public PointSource {
 public:
  LasSource(LasHeader header, std::unique_ptr<LasPoints> points, bool colours)
      : header_(std::move(header)),
        points_(std::move(points)),
        colours_(colours && header_.layout.rgb) {}

  std::size_t points() const override { return static_cast<std::size_t>(header_.points); }
  std::size_t chunks() const override { return points_->chunks(); }
  std::size_t firstPoint(std::size_t chunk) const override { return points_->firstPoint(chunk); }
  ColourKind colourKind() const override {
    return colours_ ? ColourKind::kWideInteger : ColourKind::kNone;
  }
  bool floatCoordinates() const override { return false; }
  bool dear() const override { return header_.compressed; }

  void decode(std::size_t chunk, const Sink& sink) const override {
    PointBlock block;
    const LasWanted wanted = colours_ ? LasWanted::kPlaceColours : LasWanted::kPlace;
    points_->decode(chunk, wanted, [&](const std::byte* records, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        take(records + i * header_.layout.length, block);
        if (block.count < PointBlock::kCapacity) continue;
        sink(block);
        block.count = 0;
        block.withheld = 0;
      }
    });
    if (block.count > 0 || block.withheld > 0) sink(block);
  }

 private:
  void take(const std::byte* record, PointBlock& block) const {
    if (header_.layout.withheld(record)) {
      ++block.withheld;
      return;
    }
    const std::size_t i = block.count++;
    const Eigen::Vector3d point = header_.pointOf(record);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block.xyz[axis][i] = point[static_cast<Eigen::Index>(axis)];
    }
    if (!colours_) return;
    for (std::size_t c = 0; c < 3; ++c) {
      block.wide[c][i] = loadLe<std::uint16_t>(record + *header_.layout.rgb + 2 * c);
    }
  }

  LasHeader header_;
  std::unique_ptr<LasPoints> points_;
  bool colours_;
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
  opened.source =
      std::make_unique<LasSource>(std::move(header), std::move(points), options.colours);
  return opened;
}

}  // namespace agricolmap::io
