#include "agricolmap/io/raster/map_files.hpp"

#include <fmt/format.h>

#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"

namespace agricolmap::io {
namespace {

bool isThere(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored);
}

}  // namespace

MapFiles mapFilesOf(const std::string& text) {
  if (isThere(text)) return {text, std::nullopt, looksLikeRaster(text)};
  const std::size_t first = text.find(',');
  if (first == std::string::npos) return {text, std::nullopt, false};
  for (std::size_t at = first; at != std::string::npos; at = text.find(',', at + 1)) {
    const std::string ortho = text.substr(0, at);
    const std::string model = text.substr(at + 1);
    if (isThere(ortho) && isThere(model)) return {ortho, model, true};
  }
  const std::string ortho = text.substr(0, first);
  throw InputError(fmt::format("{}: there is no such file, as the {} of {}",
                               isThere(ortho) ? text.substr(first + 1) : ortho,
                               isThere(ortho) ? "surface model" : "orthomosaic", text));
}

FileCrs crsOfMap(const MapFiles& files, const std::string& given) {
  if (!files.raster) return crsOf(files.main, given);
  FileCrs found;
  found.name = files.main.string();
  if (given.empty()) found.crs = crsFromWkt(readRasterShape(files.main).place.crs);
  if (!found.crs) found = crsOf(files.main, given);
  if (found.crs) found.crs->vertical_unit = 1.0;
  return found;
}

Cloud readMap(const MapFiles& files, const ReadOptions& read, const ImportOptions& options) {
  if (!files.raster) return readCloud(files.main, read);
  return importOrtho(files.main, files.model, options, read.map);
}

std::unique_ptr<PointStream> streamMap(const MapFiles& files, const StreamOptions& options) {
  if (!files.raster) return streamCloud(files.main, options);
  Cloud cloud = readMap(files, options.read);
  cloud.crs = options.crs;
  return keptStream(std::move(cloud));
}

}  // namespace agricolmap::io
