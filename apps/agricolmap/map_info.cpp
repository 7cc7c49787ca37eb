#include "map_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "map_folder.hpp"

namespace agricolmap {
namespace {

/// The layers that are there, by name.
std::vector<std::string> layersIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "layers", error)) {
    if (entry.path().extension() == ".tif") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

/// Of the words that map.json has for a source, those that name it.
std::string nameOf(const nlohmann::json& source) {
  std::vector<std::string> words;
  for (const char* key : {"kind", "id", "name", "file", "date"}) {
    const auto word = source.find(key);
    if (word == source.end()) continue;
    if (word->is_string()) words.push_back(word->get<std::string>());
    if (word->is_number()) words.push_back(word->dump());
  }
  return fmt::format("{}", fmt::join(words, ", "));
}

void printSources(const nlohmann::json& description) {
  const auto sources = description.find("sources");
  if (sources == description.end() || !sources->is_array()) {
    fmt::print("sources    not said\n");
    return;
  }
  fmt::print("sources    {}\n", sources->size());
  for (const nlohmann::json& source : *sources) {
    if (!source.is_object()) continue;
    fmt::print("  {:<8} {}\n", source.value("code", nlohmann::json("?")).dump(), nameOf(source));
  }
}

}  // namespace

void printMapInfo(const std::filesystem::path& folder) {
  const MapFolder map = openMapFolder(folder);
  const auto surface = map.layer("surface");
  if (!surface) {
    throw InputError(
        fmt::format("{}: has no layer layers/surface.tif; make the map anew with agricolmap fuse",
                    folder.string()));
  }
  const io::LayerShape shape = io::readLayerShape(*surface);
  const GridFrame& frame = shape.frame;
  const Eigen::Vector2d low = shape.origin.head<2>() + frame.corner;
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  const std::optional<Crs> crs = io::crsFromWkt(shape.crs);
  const std::vector<std::string> layers = layersIn(folder);
  fmt::print("map        of version {}\n", map.description.at("format_version").dump());
  fmt::print("system     {}\n", crs ? crs->name : "not said; taken as metres");
  printSources(map.description);
  fmt::print("layers     {}: {}\n", layers.size(), fmt::join(layers, ", "));
  fmt::print("cells      {} x {} of {:g} m\n", frame.cols, frame.rows, frame.cell);
  fmt::print("x          {:.3f} to {:.3f} m\n", low.x(), low.x() + size.x());
  fmt::print("y          {:.3f} to {:.3f} m\n", low.y(), low.y() + size.y());
  fmt::print("extent     {:.2f} x {:.2f} m\n", size.x(), size.y());
}

}  // namespace agricolmap
