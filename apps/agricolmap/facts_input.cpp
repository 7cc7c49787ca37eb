#include "facts_input.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/crop/fine_strips.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"

namespace agricolmap {
namespace {

/// Corner in file coordinates.
GridFrame placedFrame(const io::LayerShape& shape) {
  GridFrame frame = shape.frame;
  frame.corner += shape.origin.head<2>();
  return frame;
}

bool sameLattice(const GridFrame& a, const GridFrame& b) {
  return a.rows == b.rows && a.cols == b.cols && std::abs(a.cell - b.cell) < 1e-9 &&
         (a.corner - b.corner).norm() < 1e-3 * a.cell;
}

/// The band of that name, as `fuse` calls it. Throws InputError where there is none.
Raster<float> bandOf(io::Layer<float>& layer, const std::string& name) {
  for (std::size_t i = 0; i < layer.bands.size(); ++i) {
    if (layer.shape.bands[i] == name) return std::move(layer.bands[i]);
  }
  throw InputError(fmt::format("{}: has no band '{}'; make the map anew", layer.shape.name, name));
}

/// Frames are about `origin`.
std::vector<crop::FineStrip> fineStripsOf(const std::filesystem::path& folder,
                                          const report::StoredMap& stored,
                                          const Eigen::Vector2d& origin) {
  std::vector<crop::FineStrip> strips;
  for (const report::MapSource& source : stored.strips) {
    const std::filesystem::path path = folder / "fine" / (source.id + ".tif");
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) continue;  // one that owns nothing
    io::Layer<float> layer = io::readLayer<float>(path);
    GridFrame frame = placedFrame(layer.shape);
    frame.corner -= origin;
    strips.push_back({frame, bandOf(layer, "excess green"), bandOf(layer, "plant height")});
  }
  return strips;
}

/// The colours of a map's folder, about another origin; without rasters where it has none.
report::ColourMap coloursOf(const std::filesystem::path& folder, const Eigen::Vector2d& origin) {
  const std::filesystem::path path = folder / "layers/colour.tif";
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {};
  io::Layer<Rgb> layer = io::readLayer<Rgb>(path);
  report::ColourMap colours{placedFrame(layer.shape), std::move(layer.bands.front()),
                            std::move(layer.valid)};
  colours.frame.corner -= origin;
  return colours;
}

FactsInput readMapFolder(const std::filesystem::path& folder) {
  // Before its layers: of a folder that is no map this is what should be said.
  const report::StoredMap stored = report::readSharedMap(folder);
  io::Layer<float> exg = io::readLayer<float>(folder / "layers/exg.tif");
  FactsInput input;
  crop::FieldLayers& layers = input.layers;
  layers.above_ground = true;
  if (const auto crs = io::crsFromWkt(exg.shape.crs)) input.crs = *crs;
  layers.frame = placedFrame(exg.shape);
  layers.exg = std::move(exg.bands.front());
  std::error_code ignored;
  // A map of clouds without heights has no such layer.
  if (const auto path = folder / "layers/plant_height.tif";
      std::filesystem::exists(path, ignored)) {
    io::Layer<float> height = io::readLayer<float>(path);
    if (!sameLattice(layers.frame, placedFrame(height.shape))) {
      throw InputError(
          fmt::format("{}: has not the cells of exg.tif; make the map anew", path.string()));
    }
    layers.height = std::move(height.bands.front());
  }
  layers.origin = layers.frame.corner.array().floor().matrix();
  layers.frame.corner -= layers.origin;
  crop::refine(layers, fineStripsOf(folder, stored, layers.origin));
  input.colours = coloursOf(folder, layers.origin);
  if (const auto page = folder / "map.html"; std::filesystem::exists(page, ignored)) {
    input.map_page = page;
  }
  return input;
}

FactsInput readCloudInput(const std::string& path, const std::string& given, Progress& progress) {
  const io::MapFiles files = io::mapFilesOf(path);
  const io::FileCrs crs = io::crsOfMap(files, given);
  printWarnings(crs.warnings);
  if (crs.crs && !io::isProjected(*crs.crs)) {
    throw InputError(fmt::format(
        "{}: its coordinates are degrees ({}); bring them into a projected system first: "
        "agricolmap convert --to-crs",
        path, crs.crs->name));
  }
  io::StreamOptions options;
  options.on_pass = progress.ofPasses();
  const std::unique_ptr<PointStream> cloud = io::streamMap(files, options);
  FactsInput input;
  if (crs.crs) input.crs = *crs.crs;
  input.layers = crop::layersOf(*cloud);
  input.colours = {input.layers.frame, std::move(input.layers.colour),
                   std::move(input.layers.coloured)};
  return input;
}

}  // namespace

FactsInput readFactsInput(const std::string& path, const std::string& crs, Progress& progress) {
  std::error_code error;
  if (!std::filesystem::is_directory(path, error)) return readCloudInput(path, crs, progress);
  if (!crs.empty()) throw UsageError("--crs is for clouds; a map says where it lies");
  return readMapFolder(path);
}

}  // namespace agricolmap
