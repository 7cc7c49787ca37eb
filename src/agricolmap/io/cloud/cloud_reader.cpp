#include "agricolmap/io/cloud/cloud_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/pcd_reader.hpp"
#include "agricolmap/io/cloud/ply_reader.hpp"
#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/las/las_reader.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

bool looksLikePly(std::string_view text) {
  return text.starts_with("ply\n") || text.starts_with("ply\r\n");
}

/// The first line that is no comment tells.
bool looksLikePcd(std::string_view text) {
  constexpr std::size_t kMaxLines = 100;
  for (std::size_t line = 0; line < kMaxLines && !text.empty(); ++line) {
    std::string_view rest = takeLine(text);
    const std::string_view word = takeWord(rest);
    if (word.empty() || word.starts_with('#')) continue;
    return word == "VERSION" || word == "FIELDS" || word == "COLUMNS";
  }
  return false;
}

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
  if (looksLikePly(file.text())) return readPly(file, name, options);
  if (looksLikePcd(file.text().substr(0, 1U << 16))) return readPcd(file, name, options);
  if (looksLikeLas(file.text())) return readLas(file, name, options);
  throw InputError(fmt::format("{}: not a point cloud: {}", name, remedyFor(file.text())));
}

}  // namespace agricolmap::io
