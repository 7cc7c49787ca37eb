#include "prescribe_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/raster_place.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"

namespace agricolmap {
namespace fs = std::filesystem;
namespace {

constexpr const char* kFacts = "facts.gpkg";
/// Layers whose numbers stand for something else.
constexpr std::array<const char*, 3> kCodes = {"colour", "source", "date"};
constexpr double kMostCells = 4e8;

std::string layersIn(const fs::path& folder) {
  std::set<std::string> names;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder / "layers", ignored)) {
    const std::string name = entry.path().stem();
    if (entry.path().extension() != ".tif") continue;
    if (std::ranges::find(kCodes, name) == kCodes.end()) names.insert(name);
  }
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

/// Of a layer that does not say, what was given.
Crs crsOfLayer(const std::string& own, const std::string& given, const std::string& name) {
  const std::string& known = own.empty() ? given : own;
  if (const auto crs = io::crsFromWkt(known)) return *crs;
  throw InputError(fmt::format(
      "{}: it does not say its coordinate system, and a machine finds its way by longitude and "
      "latitude alone; say it: --crs EPSG:32632, or when the map's clouds are registered",
      name));
}

/// Longitudes, feet and Web Mercator are none of the metres that squares are made of.
void requireMetres(const std::string& name, const PrescribeInput& input) {
  Eigen::Affine2d world_from_pixel = Eigen::Affine2d::Identity();
  world_from_pixel.linear().diagonal() << input.frame.cell, -input.frame.cell;
  world_from_pixel.translation() = input.frame.corner;
  io::checkMetres(name, {world_from_pixel, input.crs.wkt});
}

PrescribeInput readRaster(const fs::path& path, const std::string& layer, bool by_band,
                          const std::string& crs) {
  io::Layer<float> read = io::readLayer<float>(path);
  const std::vector<std::string>& bands = read.shape.bands;
  std::size_t band = 0;
  if (by_band && !layer.empty()) {
    band = static_cast<std::size_t>(std::ranges::find(bands, layer) - bands.begin());
  }
  if (by_band && (band == bands.size() || (layer.empty() && bands.size() > 1))) {
    std::string names;
    for (const std::string& name : bands) names += fmt::format(" '{}'", name);
    throw InputError(
        fmt::format("{}: say which of its bands is meant: --layer{}", path.string(), names));
  }
  PrescribeInput input;
  input.crs = crsOfLayer(read.shape.crs, crs, path.string());
  input.frame = read.shape.frame;
  input.frame.corner += read.shape.origin.head<2>();
  requireMetres(path.string(), input);
  input.layer = layer.empty() ? path.stem().string() : layer;
  input.unit = read.shape.units[band];
  input.values = std::move(read.bands[band]);
  return input;
}

PrescribeInput readMapLayer(const fs::path& folder, const std::string& layer,
                            const std::string& crs) {
  const report::StoredMap map = report::readSharedMap(folder);
  const std::string known = layersIn(folder);
  if (layer.empty()) {
    throw UsageError(fmt::format("{}: say which layer rates are to follow: --layer, of {}",
                                 folder.string(), known));
  }
  if (std::ranges::find(kCodes, layer) != kCodes.end()) {
    throw UsageError(fmt::format(
        "the layer '{}' is no quantity that rates could follow; there are {}", layer, known));
  }
  const auto path = map.layer(layer);
  if (!path) {
    throw InputError(fmt::format("{}: has no layer '{}'; it has {}{}", folder.string(), layer,
                                 known, map.flat ? " (its clouds have no heights)" : ""));
  }
  return readRaster(*path, layer, false, crs);
}

/// Squares of one size on multiples of it become the cells of a raster; those at the edge of which
/// the map has shown too little stay empty.
PrescribeInput readSquares(const fs::path& folder, const std::string& field, const std::string& crs,
                           double least_seen) {
  const fs::path path = folder / kFacts;
  const io::ValuedPolygons squares = io::readValues(path, "grid", field);
  const io::ValuedPolygons seen = io::readValues(path, "grid", "seen_m2");
  if (squares.polygons.empty()) {
    throw InputError(fmt::format("{}: has no squares", path.string()));
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::Vector2d low = Eigen::Vector2d::Constant(kInfinity);
  Eigen::Vector2d high = -low;
  for (const io::ValuedPolygon& square : squares.polygons) {
    for (const Eigen::Vector2d& corner : square.corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  const std::vector<Eigen::Vector2d>& first = squares.polygons.front().corners;
  PrescribeInput input;
  input.frame.corner = low;
  input.frame.cell = (first[1] - first[0]).norm();
  const Eigen::Array2d count = ((high - low).array() / input.frame.cell).round();
  if (!(input.frame.cell > 0.0) || !(count.prod() < kMostCells)) {
    throw InputError(
        fmt::format("{}: its layer grid is no grid of squares; make it anew with agricolmap facts",
                    path.string()));
  }
  input.frame.cols = static_cast<int>(count.x());
  input.frame.rows = static_cast<int>(count.y());
  input.values =
      Raster<float>(input.frame.rows, input.frame.cols, std::numeric_limits<float>::quiet_NaN());
  const double least = least_seen * input.frame.cell * input.frame.cell;
  for (std::size_t i = 0; i < squares.polygons.size(); ++i) {
    if (!(seen.polygons[i].value >= least)) continue;
    const std::vector<Eigen::Vector2d>& corners = squares.polygons[i].corners;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& corner : corners) middle += corner;
    const Eigen::Vector2d at = input.frame.cellOf(middle / static_cast<double>(corners.size()));
    const auto col = static_cast<int>(std::lround(at.x()));
    const auto row = static_cast<int>(std::lround(at.y()));
    if (!input.values.contains(row, col)) continue;
    input.values(row, col) = static_cast<float>(squares.polygons[i].value);
  }
  input.crs = crsOfLayer(squares.crs.wkt, crs, path.string());
  requireMetres(path.string(), input);
  input.layer = field;
  return input;
}

}  // namespace

PrescribeInput readPrescribeInput(const std::string& source, const std::string& layer,
                                  const std::string& crs, double least_seen) {
  std::error_code error;
  if (!fs::is_directory(source, error)) return readRaster(source, layer, true, crs);
  if (!report::isSharedMap(source) && fs::exists(fs::path(source) / kFacts, error)) {
    if (layer.empty()) {
      throw UsageError(fmt::format(
          "{}: say which field of its squares rates are to follow: --layer weed_share, cover, ...",
          source));
    }
    return readSquares(source, layer, crs, least_seen);
  }
  return readMapLayer(source, layer, crs);
}

}  // namespace agricolmap
