#include "map_info.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"

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

void printSource(std::size_t code, const report::MapSource& source) {
  fmt::print("  {:<8} {}, {}{}\n", code, source.id, source.file,
             source.date == 0 ? "" : fmt::format(", {}", source.date));
}

}  // namespace

void printMapInfo(const std::filesystem::path& folder) {
  const report::StoredMap map = report::readSharedMap(folder);
  // The one layer that every map has.
  const auto source = map.layer("source");
  if (!source) {
    throw InputError(
        fmt::format("{}: has no layer layers/source.tif; make the map anew with agricolmap fuse",
                    folder.string()));
  }
  const io::LayerShape shape = io::readLayerShape(*source);
  const GridFrame& frame = shape.frame;
  const Eigen::Vector2d low = shape.origin.head<2>() + frame.corner;
  const Eigen::Vector2d size = frame.cell * Eigen::Vector2d(frame.cols, frame.rows);
  const std::optional<Crs> crs = io::crsFromWkt(shape.crs);
  const std::vector<std::string> layers = layersIn(folder);
  fmt::print("system     {}\n", crs ? crs->name : "not said; taken as metres");
  fmt::print("sources    {}\n", 1 + map.strips.size());
  printSource(fuse::kFixedSource, map.fixed);
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    printSource(fuse::kFixedSource + 1 + i, map.strips[i]);
  }
  fmt::print("layers     {}: {}\n", layers.size(), fmt::join(layers, ", "));
  fmt::print("cells      {} x {} of {:g} m\n", frame.cols, frame.rows, frame.cell);
  fmt::print("x          {:.3f} to {:.3f} m\n", low.x(), low.x() + size.x());
  fmt::print("y          {:.3f} to {:.3f} m\n", low.y(), low.y() + size.y());
  fmt::print("extent     {:.2f} x {:.2f} m\n", size.x(), size.y());
}

}  // namespace agricolmap
