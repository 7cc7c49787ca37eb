#include "agricolmap/io/cloud/cloud_reader.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/pcd_reader.hpp"
#include "agricolmap/io/cloud/ply_reader.hpp"
#include "agricolmap/io/cloud/xyz_reader.hpp"
#include "agricolmap/io/las/las_reader.hpp"
#include "agricolmap/io/text/foreign_file.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {
namespace {

std::string remedyFor(std::string_view bytes) {
  const std::string known = describeForeign(bytes);
  if (!known.empty()) return known;
  return "known are LAS, LAZ, PLY, PCD and text with lines 'x y z' or 'x y z r g b'";
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
      case CloudFormat::kXyz:
        return readXyz(file, name, options);
    }
  }
  throw InputError(fmt::format("{}: not a point cloud: {}", name, remedyFor(file.text())));
}

}  // namespace agricolmap::io
