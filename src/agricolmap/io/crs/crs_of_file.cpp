// Which coordinate system a cloud's file is in.
#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/crs/srs.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// No definition is longer; a file that is, is none.
constexpr std::size_t kMostText = 1U << 20;
constexpr std::uint16_t kWktFlag = 0x10;

std::string textOf(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string_view text = file.text().substr(0, kMostText);
  return std::string(text.substr(0, text.find('\0')));
}

std::optional<OGRSpatialReference> srsOfWktRecord(const LasHeader& header) {
  constexpr std::uint16_t kWkt = 2112;
  const LasRecord* const record = header.find("LASF_Projection", kWkt);
  if (record == nullptr || record->data.empty()) return std::nullopt;
  const std::string_view text(reinterpret_cast<const char*>(record->data.data()),
                              record->data.size());
  return srsFrom(std::string(text.substr(0, text.find('\0'))));
}

/// Whether a LAS file has any record that is about it.
bool saysCrs(const LasHeader& header) {
  for (const LasRecord& record : header.records) {
    if (record.user == "LASF_Projection" && (record.id == 2112 || record.id == 34735)) return true;
  }
  return false;
}

void readLasCrs(const std::filesystem::path& path, FileCrs& found) {
  const MappedFile file(path);
  if (!looksLikeLas(file.text())) return;
  const LasHeader header = parseLasHeader(file.bytes(), found.name);
  if (!saysCrs(header)) return;
  const bool wkt_first = (header.flags & kWktFlag) != 0;
  auto srs = wkt_first ? srsOfWktRecord(header) : srsFromGeoKeys(header);
  if (!srs) srs = wkt_first ? srsFromGeoKeys(header) : srsOfWktRecord(header);
  if (!srs) {
    found.warnings.push_back(fmt::format(
        "{}: what it says of its coordinate system cannot be understood; taken as not said",
        found.name));
    return;
  }
  found.crs = crsFrom(*srs);
  if (const auto unit = verticalUnitOf(header)) {
    found.crs->vertical_unit = *unit;
  } else if (srs->IsVertical() == 0 && found.crs->vertical_unit != 1.0) {
    found.warnings.push_back(fmt::format(
        "{}: it does not say the unit of its heights; taken is that of x and y ({:.10g} m)",
        found.name, found.crs->vertical_unit));
  }
}

/// "WGS84 UTM 32N", as OpenDroneMap begins coords.txt, as a code; other texts as they are.
std::string codeOf(const std::string& text) {
  std::string_view rest = text;
  const std::string_view line = takeLine(rest, lineEndOf(text));
  constexpr std::string_view kBegin = "WGS84 UTM ";
  if (!line.starts_with(kBegin) || line.size() < kBegin.size() + 2) return text;
  const auto zone = parseInteger(line.substr(kBegin.size(), line.size() - kBegin.size() - 1));
  const char side = line.back();
  if (!zone || *zone < 1 || *zone > 60 || (side != 'N' && side != 'S')) return text;
  return fmt::format("EPSG:{}", (side == 'N' ? 32600 : 32700) + *zone);
}

/// A definition, or the file that has it.
Crs givenCrs(const std::string& given) {
  std::error_code ignored;
  const bool is_file = std::filesystem::is_regular_file(given, ignored);
  const auto srs = srsFrom(codeOf(is_file ? textOf(given) : given));
  if (!srs) {
    throw UsageError(
        fmt::format("'{}' is no coordinate system; known are codes as EPSG:32632, WKT, PROJ's text "
                    "and files with one of these",
                    given));
  }
  return crsFrom(*srs);
}

void readCrsBeside(const std::filesystem::path& cloud, FileCrs& found) {
  for (const char* const ending : {".prj", "_wkt.prj"}) {
    std::filesystem::path path = cloud;
    path.replace_filename(cloud.stem().string() + ending);
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) continue;
    const auto srs = srsFrom(textOf(path));
    if (!srs) {
      throw InputError(
          fmt::format("{}: is no coordinate system; mend it or take it away from beside the cloud",
                      path.string()));
    }
    found.crs = crsFrom(*srs);
    return;
  }
  for (const char* const odm : {"proj.txt", "coords.txt"}) {
    const std::filesystem::path path = cloud.parent_path() / odm;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) continue;
    found.warnings.push_back(fmt::format(
        "{}: it does not say its coordinate system, and {} beside it is not asked; give it as the "
        "coordinate system if it is of this file",
        found.name, path.string()));
    return;
  }
}

}  // namespace

std::optional<Crs> crsFromWkt(const std::string& wkt) {
  if (wkt.empty()) return std::nullopt;
  requireProjDatabase();
  const auto srs = srsFrom(wkt);
  if (!srs) throw InputError(fmt::format("the coordinate system {} cannot be understood", wkt));
  return crsFrom(*srs);
}

FileCrs crsOf(const std::filesystem::path& cloud, const std::string& given) {
  FileCrs found;
  found.name = cloud.string();
  if (!given.empty()) {
    found.crs = givenCrs(given);
  } else {
    readLasCrs(cloud, found);
    if (!found.crs) readCrsBeside(cloud, found);
  }
  if (found.crs) requireProjDatabase();
  return found;
}

}  // namespace agricolmap::io
