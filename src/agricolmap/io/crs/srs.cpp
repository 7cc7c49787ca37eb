#include "agricolmap/io/crs/srs.hpp"

#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <fmt/format.h>
#include <gdal_priv.h>

#include <cmath>
#include <cstring>
#include <mutex>
#include <vector>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

/// GeoTIFF keys are read by GDAL, which takes them from a TIFF: one of a single pixel.
class TinyTiff {
 public:
  TinyTiff() {
    add(256, std::uint16_t{1});
    add(257, std::uint16_t{1});
    add(258, std::uint16_t{8});
    add(259, std::uint16_t{1});
    add(262, std::uint16_t{1});
    add(273, std::uint32_t{0});  // the pixel may be any byte: the first
    add(277, std::uint16_t{1});
    add(278, std::uint16_t{1});
    add(279, std::uint32_t{1});
    const double ones[] = {1.0, 1.0, 0.0};
    const double tie[] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    add(33550, kDouble, std::as_bytes(std::span(ones)), 3);
    add(33922, kDouble, std::as_bytes(std::span(tie)), 6);
  }
  /// Tags must be added in ascending order.
  void add(std::uint16_t tag, std::uint16_t type, std::span<const std::byte> data,
           std::size_t count) {
    entries_.push_back({tag, type, static_cast<std::uint32_t>(count), {data.begin(), data.end()}});
  }
  static constexpr std::uint16_t kAscii = 2;
  static constexpr std::uint16_t kShort = 3;
  static constexpr std::uint16_t kLong = 4;
  static constexpr std::uint16_t kDouble = 12;

  std::vector<std::byte> bytes() const {
    constexpr std::size_t kHead = 8;
    constexpr std::size_t kEntry = 12;
    std::vector<std::byte> file(kHead + 2 + entries_.size() * kEntry + 4);
    std::memcpy(file.data(), "II*\0", 4);
    storeLe(&file[4], static_cast<std::uint32_t>(kHead));
    storeLe(&file[kHead], static_cast<std::uint16_t>(entries_.size()));
    std::size_t at = kHead + 2;
    for (const Entry& entry : entries_) {
      storeLe(&file[at], entry.tag);
      storeLe(&file[at + 2], entry.type);
      storeLe(&file[at + 4], entry.count);
      if (entry.data.size() <= 4) {
        std::copy(entry.data.begin(), entry.data.end(), &file[at + 8]);
      } else {
        storeLe(&file[at + 8], static_cast<std::uint32_t>(file.size()));
        file.insert(file.end(), entry.data.begin(), entry.data.end());
      }
      at += kEntry;
    }
    return file;
  }

 private:
  template <typename T>
  void add(std::uint16_t tag, T value) {
    add(tag, sizeof(T) == 2 ? kShort : kLong, std::as_bytes(std::span(&value, 1)), 1);
  }
  struct Entry {
    std::uint16_t tag;
    std::uint16_t type;
    std::uint32_t count;
    std::vector<std::byte> data;
  };
  std::vector<Entry> entries_;
};

/// A file of GDAL's that lies in memory, gone with this.
class MemoryRaster {
 public:
  explicit MemoryRaster(std::vector<std::byte> bytes)
      : bytes_(std::move(bytes)),
        name_(fmt::format("/vsimem/agricolmap_{}.tif", static_cast<const void*>(bytes_.data()))) {
    VSILFILE* const file = VSIFileFromMemBuffer(
        name_.c_str(), reinterpret_cast<GByte*>(bytes_.data()), bytes_.size(), FALSE);
    if (file != nullptr) VSIFCloseL(file);
  }
  ~MemoryRaster() { VSIUnlink(name_.c_str()); }
  MemoryRaster(const MemoryRaster&) = delete;
  MemoryRaster& operator=(const MemoryRaster&) = delete;
  const char* name() const { return name_.c_str(); }

 private:
  std::vector<std::byte> bytes_;
  std::string name_;
};

}  // namespace

void requireProjDatabase() {
  const QuietGdal quiet;
  OGRSpatialReference probe;
  if (probe.importFromEPSG(4326) == OGRERR_NONE) return;
  throw Error(ErrorKind::kInternal,
              "PROJ does not find its database (proj.db), without which coordinate systems cannot "
              "be told apart: install proj-data, and let PROJ_LIB, if set, name its folder");
}

std::optional<OGRSpatialReference> srsFrom(const std::string& definition) {
  const QuietGdal quiet;
  OGRSpatialReference srs;
  // No network, and no file: the caller reads those.
  const char* const options[] = {"ALLOW_NETWORK_ACCESS=NO", "ALLOW_FILE_ACCESS=NO", nullptr};
  if (srs.SetFromUserInput(definition.c_str(), options) != OGRERR_NONE) return std::nullopt;
  srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return srs;
}

std::optional<OGRSpatialReference> srsFromGeoKeys(const LasHeader& header) {
  constexpr std::array<std::uint16_t, 3> kTags{34735, 34736, 34737};
  constexpr std::array kTypes{TinyTiff::kShort, TinyTiff::kDouble, TinyTiff::kAscii};
  constexpr std::array<std::size_t, 3> kSizes{2, 8, 1};
  TinyTiff tiff;
  for (std::size_t i = 0; i < kTags.size(); ++i) {
    const LasRecord* const record = header.find("LASF_Projection", kTags[i]);
    if (record == nullptr || record->data.size() < kSizes[i]) continue;
    tiff.add(kTags[i], kTypes[i], record->data, record->data.size() / kSizes[i]);
  }
  const QuietGdal quiet;
  static std::once_flag registered;
  std::call_once(registered, [] { GDALAllRegister(); });
  const CPLConfigOptionSetter heights("GTIFF_REPORT_COMPD_CS", "YES", true);  // this thread's
  const MemoryRaster file(tiff.bytes());
  const char* const drivers[] = {"GTiff", nullptr};
  const GDALDatasetUniquePtr dataset(
      GDALDataset::Open(file.name(), GDAL_OF_RASTER | GDAL_OF_READONLY, drivers));
  if (!dataset || dataset->GetSpatialRef() == nullptr) return std::nullopt;
  OGRSpatialReference srs = *dataset->GetSpatialRef();
  srs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return srs;
}

std::optional<double> verticalUnitOf(const LasHeader& header) {
  constexpr std::uint16_t kDirectory = 34735;
  constexpr std::uint16_t kVerticalUnits = 4099;
  constexpr std::size_t kKey = 8;
  const LasRecord* const record = header.find("LASF_Projection", kDirectory);
  if (record == nullptr) return std::nullopt;
  for (std::size_t at = kKey; at + kKey <= record->data.size(); at += kKey) {
    if (loadLe<std::uint16_t>(&record->data[at]) != kVerticalUnits) continue;
    switch (loadLe<std::uint16_t>(&record->data[at + 6])) {
      case 9001:
        return 1.0;
      case 9002:
        return 0.3048;
      case 9003:
        return 1200.0 / 3937.0;
      default:
        return std::nullopt;
    }
  }
  return std::nullopt;
}

OGRSpatialReference horizontalOf(const OGRSpatialReference& srs) {
  OGRSpatialReference horizontal = srs;
  if (horizontal.IsCompound() != 0) horizontal.StripVertical();
  horizontal.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return horizontal;
}

Crs crsFrom(const OGRSpatialReference& srs) {
  const QuietGdal quiet;
  Crs crs;
  const char* const name = srs.GetName();
  crs.name = name == nullptr ? "unnamed" : name;
  char* wkt = nullptr;
  if (srs.exportToWkt(&wkt) != OGRERR_NONE || wkt == nullptr || *wkt == '\0') {
    CPLFree(wkt);
    wkt = nullptr;
    const char* const newer[] = {"FORMAT=WKT2_2019", nullptr};
    srs.exportToWkt(&wkt, newer);
  }
  crs.wkt = wkt == nullptr ? "" : wkt;
  CPLFree(wkt);
  const char* unit = nullptr;
  const OGRSpatialReference horizontal = horizontalOf(srs);
  if (horizontal.IsProjected() != 0 || horizontal.IsLocal() != 0) {
    crs.horizontal_unit = horizontal.GetLinearUnits(&unit);
  }
  crs.vertical_unit = crs.horizontal_unit;
  if (srs.IsVertical() != 0) {
    crs.vertical_unit = srs.GetTargetLinearUnits("VERT_CS", &unit);
  }
  return crs;
}

}  // namespace agricolmap::io
