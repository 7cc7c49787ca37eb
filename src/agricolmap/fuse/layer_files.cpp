#include "agricolmap/fuse/layer_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "agricolmap/fuse/fine_layers.hpp"
#include "agricolmap/io/raster/geo_writer.hpp"
#include "agricolmap/io/raster/mosaic_writer.hpp"

namespace agricolmap::fuse {
namespace {

/// Writes files of one grid and keeps their names.
class Files {
 public:
  Files(const Place& place, const GridFrame& frame, const Eigen::Vector3d& origin, const Crs& crs)
      : place_(place) {
    layer_.frame = frame;
    layer_.origin = origin;
    layer_.crs = crs.wkt;
  }

  void floats(const std::string& name, std::vector<io::GeoBand> bands, double add = 0.0) {
    io::GeoLayer layer = layer_;
    layer.bands = std::move(bands);
    layer.add = add;
    layer.nodata = std::numeric_limits<double>::quiet_NaN();
    write(name, std::move(layer));
  }
  /// Numbers that stand for something, 0 for nothing.
  void codes(const std::string& name, io::GeoBand band) {
    io::GeoLayer layer = layer_;
    layer.bands = {std::move(band)};
    layer.nodata = 0.0;
    layer.overviews = io::Overviews::kNearest;
    write(name, std::move(layer));
  }
  void colours(const std::string& name, const Raster<Rgb>& colour,
               const Raster<std::uint8_t>& mask) {
    io::GeoLayer layer = layer_;
    layer.bands = {{&colour, "", ""}};
    layer.mask = &mask;
    write(name, std::move(layer));
  }
  std::vector<std::string> take() { return std::move(names_); }

 private:
  void write(const std::string& name, io::GeoLayer layer) {
    layer.metadata["AGRICOLMAP_LAYER"] = name;
    io::writeLayer(place_(name), layer);
    names_.push_back(name);
  }
  const Place& place_;
  io::GeoLayer layer_;
  std::vector<std::string> names_;
};

std::vector<std::string> writeWhole(const Place& place, const SharedMap& map, const Crs& crs) {
  const Layers& layers = map.layers;
  Files files(place, layers.frame, layers.origin, crs);
  if (!map.flat) {
    const double up = layers.origin.z();
    files.floats("layers/surface.tif", {{&layers.surface, "surface", "m"}}, up);
    files.floats("layers/ground.tif", {{&layers.ground, "ground", "m"}}, up);
    files.floats("layers/plant_height.tif", {{&layers.plant_height, "plant height", "m"}});
  }
  files.floats("layers/exg.tif", {{&layers.exg, "excess green", ""}});
  files.floats("layers/cover.tif", {{&layers.cover, "vegetation cover", ""}});
  files.floats("layers/density.tif", {{&layers.density, "point density", "1/m2"}});
  files.floats("layers/error.tif", {{&layers.plane_error, "plane error", "m"},
                                    {&layers.height_error, "height error", "m"}});
  files.codes("layers/source.tif", {&layers.source, "source", ""});
  const auto dated = [](std::int32_t date) { return date != 0; };
  if (std::any_of(layers.date.begin(), layers.date.end(), dated)) {
    files.codes("layers/date.tif", {&layers.date, "date", ""});
  }
  Raster<std::uint8_t> mask(layers.frame.rows, layers.frame.cols);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = layers.source[i] == kNoSource ? 0 : 255;
  files.colours("layers/colour.tif", layers.colour, mask);
  return files.take();
}

/// Where the files of a strip lie in the whole field's.
io::MosaicPiece pieceOf(const SharedMap& map, const FusedStrip& strip, const map::GridMap& own) {
  return {.file = {},
          .row = strip.cells.row * map.lattice.factor,
          .col = strip.cells.col * map.lattice.factor,
          .rows = own.frame.rows,
          .cols = own.frame.cols};
}

/// A layer of the whole field, and in which files and bands of a strip it is in fine cells.
struct FineLayer {
  const char* layer;
  const char* ending;  ///< of the strip's file
  int band;
  const char* unit;
  bool heights;  ///< whether flat maps and strips have none
};
constexpr FineLayer kFineLayers[] = {
    {"surface", "_heights.tif", 1, "m", true}, {"ground", "_heights.tif", 2, "m", true},
    {"plant_height", ".tif", 1, "m", true},    {"exg", ".tif", 2, "", false},
    {"cover", ".tif", 3, "", false},           {"density", ".tif", 4, "1/m2", false},
    {"colour", "_colour.tif", 1, "", false}};

/// The whole field in the strips' cells, of all files together: `fine/LAYER.vrt`.
std::vector<std::string> writeMosaics(
    const Place& place, const SharedMap& map,
    const std::vector<std::pair<const FusedStrip*, io::MosaicPiece>>& pieces, const Crs& crs) {
  const int factor = map.lattice.factor;
  io::Mosaic mosaic;
  mosaic.frame = map.layers.frame;
  mosaic.frame.cell /= factor;
  mosaic.frame.rows *= factor;
  mosaic.frame.cols *= factor;
  mosaic.origin = map.layers.origin;
  mosaic.crs = crs.wkt;
  std::vector<std::string> names;
  for (const FineLayer& fine : kFineLayers) {
    if (fine.heights && map.flat) continue;
    mosaic.name = fine.layer;
    mosaic.unit = fine.unit;
    mosaic.colour = std::string_view(fine.layer) == "colour";
    mosaic.pieces = {{.file = fmt::format("../layers/{}.tif", fine.layer),
                      .rows = mosaic.frame.rows,
                      .cols = mosaic.frame.cols,
                      .cells = factor}};
    for (const auto& [strip, piece] : pieces) {
      if (fine.heights && strip->flat) continue;
      mosaic.pieces.push_back(piece);
      mosaic.pieces.back().file = strip->id + fine.ending;
      mosaic.pieces.back().band = fine.band;
    }
    names.push_back(fmt::format("fine/{}.vrt", fine.layer));
    io::writeMosaic(place(names.back()), mosaic);
  }
  return names;
}

}  // namespace

std::vector<std::string> writeLayers(const Place& place, const SharedMap& map,
                                     const StripPoints& points, const FuseOptions& options,
                                     const Crs& crs) {
  std::vector<std::string> names = writeWhole(place, map, crs);
  std::vector<std::pair<const FusedStrip*, io::MosaicPiece>> pieces;
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    const FusedStrip& strip = map.strips[i];
    if (strip.owned_area <= 0.0) continue;
    const map::GridMap own = fineMap(map, i, *points[i]);
    const FineLayers fine = fineLayers(map, i, own, options.match_colours);
    Files files(place, own.frame, map.layers.origin, crs);
    // A constant per file moves all of its bands, so those above sea level have one of their own.
    if (!map.flat && !strip.flat) {
      files.floats("fine/" + strip.id + "_heights.tif",
                   {{&fine.surface, "surface", "m"}, {&fine.ground, "ground", "m"}},
                   map.layers.origin.z());
    }
    files.floats("fine/" + strip.id + ".tif", {{&fine.plant_height, "plant height", "m"},
                                               {&fine.exg, "excess green", ""},
                                               {&fine.cover, "vegetation cover", ""},
                                               {&fine.density, "point density", "1/m2"}});
    files.colours("fine/" + strip.id + "_colour.tif", fine.colour, fine.mask);
    for (std::string& name : files.take()) names.push_back(std::move(name));
    pieces.emplace_back(&strip, pieceOf(map, strip, own));
  }
  if (pieces.empty()) return names;
  for (std::string& name : writeMosaics(place, map, pieces, crs)) names.push_back(std::move(name));
  return names;
}

}  // namespace agricolmap::fuse
