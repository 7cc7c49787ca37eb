#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "agricolmap/api/field_rasters.hpp"
#include "agricolmap/change/common_grid.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/geo_reader.hpp"
#include "agricolmap/io/raster/raster_place.hpp"
#include "agricolmap/io/raster/surface_layer.hpp"
#include "agricolmap/report/json/shared_map_file.hpp"

namespace agricolmap {
namespace {

/// Reads the layers of one map, which all have the cells of the first.
class Reader {
 public:
  explicit Reader(const report::StoredMap& stored)
      : stored_(stored), shape_(io::readLayerShape(fileOf("exg"))) {}

  const io::LayerShape& shape() const { return shape_; }

  /// The bands of a layer, NaN or 0 where the map does not have it.
  template <typename Value>
  std::vector<Value> band(const std::string& name, std::size_t band = 0) const {
    const auto file = stored_.layer(name);
    if (!file) {
      const auto cells = Raster<Value>(shape_.frame.rows, shape_.frame.cols).size();
      constexpr bool kFloats = std::numeric_limits<Value>::has_quiet_NaN;
      return std::vector<Value>(cells, kFloats ? std::numeric_limits<Value>::quiet_NaN() : Value{});
    }
    io::Layer<Value> layer = io::readLayer<Value>(*file);
    GridFrame frame = layer.shape.frame;
    frame.corner += (layer.shape.origin - shape_.origin).template head<2>();
    if (!change::sameGrid(frame, shape_.frame) || layer.bands.size() <= band) {
      throw InputError(
          fmt::format("{}: has not the cells of {}, or too few bands; make the map "
                      "anew",
                      file->string(), shape_.name));
    }
    return valuesOf(layer.bands[band]);
  }

 private:
  std::filesystem::path fileOf(const char* name) const {
    if (const auto file = stored_.layer(name)) return *file;
    throw InputError(fmt::format("{}: has no layer layers/{}.tif; make the map anew",
                                 stored_.folder.string(), name));
  }

  const report::StoredMap& stored_;
  io::LayerShape shape_;
};

FieldMap emptyMap(const io::LayerShape& shape) {
  FieldMap map;
  map.rows = shape.frame.rows;
  map.cols = shape.frame.cols;
  map.cell_m = shape.frame.cell;
  map.file_from_cell = fileFromCell(shape.frame, shape.origin);
  return map;
}

/// Of a strip's file; without cells where there is none, as of one that owns nothing.
FieldMap::Fine fineOf(const std::filesystem::path& path) {
  FieldMap::Fine fine;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return fine;
  const io::Layer<float> layer = io::readLayer<float>(path);
  const auto band = [&](const std::string& name) {
    const auto found = std::ranges::find(layer.shape.bands, name);
    if (found == layer.shape.bands.end()) {
      throw InputError(fmt::format("{}: has no band '{}'; make the map anew", path.string(), name));
    }
    return valuesOf(layer.bands[static_cast<std::size_t>(found - layer.shape.bands.begin())]);
  };
  fine.rows = layer.shape.frame.rows;
  fine.cols = layer.shape.frame.cols;
  fine.cell_m = layer.shape.frame.cell;
  fine.file_from_cell = fileFromCell(layer.shape.frame, layer.shape.origin);
  fine.plant_height_m = band("plant height");
  fine.excess_green = band("excess green");
  fine.cover = band("vegetation cover");
  fine.density = band("point density");
  return fine;
}

/// A map that has no other layer.
FieldMap surfaceAlone(const std::filesystem::path& path) {
  const io::LayerShape shape = io::readLayerShape(path);
  io::checkMetres(shape.name, io::placeOf(shape));
  io::SurfaceLayer surface = io::readSurfaceLayer(path, shape);
  FieldMap map = emptyMap(shape);
  map.crs = io::crsFromWkt(shape.crs).value_or(Crs{});
  map.surface_m = valuesOf(surface.height);
  const std::vector<float> unknown(map.surface_m.size(), std::numeric_limits<float>::quiet_NaN());
  for (auto* layer : {&map.ground_m, &map.plant_height_m, &map.excess_green, &map.cover,
                      &map.density, &map.plane_error_m, &map.height_error_m}) {
    *layer = unknown;
  }
  map.colour.resize(unknown.size());
  map.date.resize(unknown.size());
  std::ranges::transform(map.surface_m, std::back_inserter(map.source), [](float height) {
    return static_cast<std::uint16_t>(std::isnan(height) ? 0 : 1);
  });
  map.fixed.name = shape.name;
  map.warnings = std::move(surface.warnings);
  return map;
}

FieldMap mapOfFolder(const std::filesystem::path& folder) {
  const report::StoredMap stored = report::readSharedMap(folder);
  const Reader reader(stored);
  const io::LayerShape& shape = reader.shape();
  FieldMap map = emptyMap(shape);
  map.crs = stored.crs;
  if (map.crs.wkt.empty()) map.crs = io::crsFromWkt(shape.crs).value_or(Crs{});
  map.surface_m = reader.band<float>("surface");
  map.ground_m = reader.band<float>("ground");
  map.plant_height_m = reader.band<float>("plant_height");
  map.excess_green = reader.band<float>("exg");
  map.cover = reader.band<float>("cover");
  map.density = reader.band<float>("density");
  map.plane_error_m = reader.band<float>("error", 0);
  map.height_error_m = reader.band<float>("error", 1);
  map.colour = reader.band<Rgb>("colour");
  map.source = reader.band<std::uint16_t>("source");
  map.date = reader.band<std::int32_t>("date");
  map.has_heights = !stored.flat;
  map.fixed = {stored.fixed.file, stored.fixed.points, stored.fixed.date};
  for (std::size_t i = 0; i < stored.strips.size(); ++i) {
    const report::StripShare& share = stored.shares[i];
    const std::string& id = stored.strips[i].id;
    map.strips.push_back({id, share.code, share.moved, share.seen_area, share.owned_area,
                          fineOf(folder / "fine" / (id + ".tif"))});
  }
  map.warnings = stored.warnings;
  return map;
}

}  // namespace

FieldMap readFieldMap(const std::filesystem::path& path) {
  requireProcessor();
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    throw InputError(fmt::format("{}: there is no such file or folder", path.string()));
  }
  return std::filesystem::is_directory(path, ignored) ? mapOfFolder(path) : surfaceAlone(path);
}

}  // namespace agricolmap
