// Stands for crs_of_file.cpp and common_frame.cpp where GDAL is not built in: nothing is known of
// coordinate systems, which is said where a file has one.
#include <fmt/format.h>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw UsageError(fmt::format(
      "{}: coordinate systems need GDAL, and this build has none (AGRICOLMAP_WITH_GDAL)", what));
}

}  // namespace

std::optional<Crs> crsFromWkt(const std::string& /*wkt*/) { return std::nullopt; }

FileCrs crsOf(const std::filesystem::path& cloud, const std::string& given) {
  if (!given.empty()) refuse(given);
  FileCrs found;
  found.name = cloud.string();
  const MappedFile file(cloud);
  if (!looksLikeLas(file.text())) return found;
  const LasHeader header = parseLasHeader(file.bytes(), found.name);
  for (const LasRecord& record : header.records) {
    if (record.user != "LASF_Projection") continue;
    found.warnings.push_back(fmt::format(
        "{}: its coordinate system is not looked at, as this build has no GDAL; its coordinates "
        "are taken as metres",
        found.name));
    break;
  }
  return found;
}

CommonFrame commonFrame(const FileCrs& fixed, const FileCrs& moving) {
  CommonFrame frame;
  frame.warnings = fixed.warnings;
  frame.warnings.insert(frame.warnings.end(), moving.warnings.begin(), moving.warnings.end());
  return frame;
}

CommonFrame frameIn(const FileCrs& /*cloud*/, const std::string& target) { refuse(target); }

bool isProjected(const Crs& /*crs*/) { return true; }

void checkGroundScale(const std::string& /*name*/, const Crs& /*crs*/,
                      const Eigen::Vector2d& /*at*/) {}

}  // namespace agricolmap::io
