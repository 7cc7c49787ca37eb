#include "facts_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"

namespace agricolmap {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
constexpr double kMostCells = 40e6;  // of a map that has finer layers in places

/// What a strip shows in cells of its own.
struct FineStrip {
  GridFrame frame;  ///< file coordinates [m]
  Raster<float> exg;
  Raster<float> height;
};

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

std::vector<FineStrip> fineStripsOf(const std::filesystem::path& folder) {
  std::vector<FineStrip> strips;
  for (const report::MapSource& source : report::readSharedMap(folder).strips) {
    const std::filesystem::path path = folder / "fine" / (source.id + ".tif");
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) continue;  // one that owns nothing
    io::Layer<float> layer = io::readLayer<float>(path);
    strips.push_back(
        {placedFrame(layer.shape), bandOf(layer, "excess green"), bandOf(layer, "plant height")});
  }
  return strips;
}

/// The mean of the cells within `side` of `point`; one cell where that is no more.
float valueAt(const GridFrame& frame, const Raster<float>& values, const Eigen::Vector2d& point,
              double side) {
  const Eigen::Vector2d at = frame.cellOf(point);
  const int reach = static_cast<int>((0.5 * side / frame.cell) + 1e-6);
  const auto col = static_cast<int>(std::lround(at.x()));
  const auto row = static_cast<int>(std::lround(at.y()));
  float sum = 0.0F;
  float count = 0.0F;
  for (int r = row - reach; r <= row + reach; ++r) {
    for (int c = col - reach; c <= col + reach; ++c) {
      if (!values.contains(r, c) || !std::isfinite(values(r, c))) continue;
      sum += values(r, c);
      count += 1.0F;
    }
  }
  return count > 0.0F ? sum / count : kNone;
}

/// Each cell cut into `finer` × `finer` of the same value.
Raster<float> cut(const Raster<float>& coarse, int finer) {
  Raster<float> fine(coarse.rows() * finer, coarse.cols() * finer);
  for (int r = 0; r < fine.rows(); ++r) {
    for (int c = 0; c < fine.cols(); ++c) fine(r, c) = coarse(r / finer, c / finer);
  }
  return fine;
}

/// Puts a strip's values in place of the map's, where it has any.
void paint(const GridFrame& from, const Raster<float>& values, const GridFrame& frame,
           Raster<float>& into) {
  const Eigen::Vector2d low = frame.cellOf(from.corner);
  const Eigen::Vector2d high =
      frame.cellOf(from.corner + from.cell * Eigen::Vector2d(from.cols, from.rows));
  const int row_end = std::min(frame.rows, static_cast<int>(std::ceil(high.y())) + 1);
  const int col_end = std::min(frame.cols, static_cast<int>(std::ceil(high.x())) + 1);
  for (int r = std::max(0, static_cast<int>(std::floor(low.y()))); r < row_end; ++r) {
    for (int c = std::max(0, static_cast<int>(std::floor(low.x()))); c < col_end; ++c) {
      const float value = valueAt(from, values, frame.centre(r, c), frame.cell - from.cell);
      if (std::isfinite(value)) into(r, c) = value;
    }
  }
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
  const std::vector<FineStrip> strips = fineStripsOf(folder);
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
  if (!strips.empty()) {
    const double most = std::sqrt(kMostCells / static_cast<double>(layers.exg.size()));
    const double ratio = std::round(layers.frame.cell / strips.front().frame.cell);
    const int finer = static_cast<int>(std::clamp(std::floor(most), 1.0, std::max(1.0, ratio)));
    layers.frame.cell /= finer;
    layers.frame.rows *= finer;
    layers.frame.cols *= finer;
    layers.exg = cut(layers.exg, finer);
    if (!layers.height.empty()) layers.height = cut(layers.height, finer);
    for (const FineStrip& strip : strips) {
      paint(strip.frame, strip.exg, layers.frame, layers.exg);
      if (!layers.height.empty()) paint(strip.frame, strip.height, layers.frame, layers.height);
    }
  }
  layers.origin = layers.frame.corner.array().floor().matrix();
  layers.frame.corner -= layers.origin;
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
