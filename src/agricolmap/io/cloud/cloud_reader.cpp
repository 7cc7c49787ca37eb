#include "agricolmap/io/cloud/cloud_reader.hpp"

#include <fmt/format.h>

#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/pcd_reader.hpp"
#include "agricolmap/io/cloud/ply_reader.hpp"
#include "agricolmap/io/las/las_reader.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {
namespace {

std::string_view remedyFor(std::string_view text) {
  if (text.starts_with("II*") || text.starts_with("MM") || text.starts_with("II+")) {
    return "it is a TIFF raster; orthophoto and surface model can be imported";
  }
  if (text.starts_with("\x89PNG")) return "it is a PNG picture";
  if (text.starts_with("ply\r")) return "its lines end in CR alone; convert it with mac2unix";
  return "known are PLY, PCD, LAS and LAZ";
}

}  // namespace

Cloud readCloud(const std::filesystem::path& path, const ReadOptions& options) {
  const MappedFile file(path);
  const std::string name = path.string();
  if (const auto format = formatByContent(file.text())) {
    switch (*format) {
      case CloudFormat::kPly:
        return readPly(file, name, options);
      case CloudFormat::kPcd:
        return readPcd(file, name, options);
      case CloudFormat::kLas:
      case CloudFormat::kLaz:
      case CloudFormat::kCopc:
        return readLas(file, name, options);
    }
  }
  throw InputError(fmt::format("{}: not a point cloud: {}", name, remedyFor(file.text())));
}

}  // namespace agricolmap::io
