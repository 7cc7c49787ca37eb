#include "agricolmap/fuse/layer_files.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/io/raster/geo_writer.hpp"

namespace agricolmap::fuse {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

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
  files.codes("layers/date.tif", {&layers.date, "date", ""});
  Raster<std::uint8_t> mask(layers.frame.rows, layers.frame.cols);
  for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = layers.source[i] == kNoSource ? 0 : 255;
  files.colours("layers/colour.tif", layers.colour, mask);
  return files.take();
}

/// What a strip shows in its own cells, where it owns those of the map.
struct FineLayers {
  Raster<float> surface, ground, plant_height, exg, cover, density;
  Raster<Rgb> colour;
  Raster<std::uint8_t> mask;
};

FineLayers fineLayers(const SharedMap& map, const FusedStrip& strip, const map::GridMap& own,
                      bool match_colours) {
  const Tone tone = match_colours ? strip.tone : Tone{};
  FineLayers fine;
  for (Raster<float>* raster :
       {&fine.surface, &fine.ground, &fine.plant_height, &fine.exg, &fine.cover, &fine.density}) {
    *raster = Raster<float>(own.frame.rows, own.frame.cols, kNone);
  }
  fine.colour = Raster<Rgb>(own.frame.rows, own.frame.cols);
  fine.mask = Raster<std::uint8_t>(own.frame.rows, own.frame.cols);
  const auto area = static_cast<float>(own.frame.cell * own.frame.cell);
  for (int r = 0; r < own.frame.rows; ++r) {
    for (int c = 0; c < own.frame.cols; ++c) {
      const std::size_t i = own.weight.index(r, c);
      const int row = strip.cells.row + r / map.lattice.factor;
      const int col = strip.cells.col + c / map.lattice.factor;
      if (!own.valid(i) || map.layers.source(row, col) != strip.code) continue;
      fine.surface[i] = own.height[i];
      fine.ground[i] = map.layers.ground(row, col);
      fine.plant_height[i] = own.height[i] - map.layers.ground(row, col);
      fine.cover[i] = strip.greenness.cover(own.exg[i]);
      fine.density[i] = own.weight[i] / area;
      fine.colour[i] = tone(own.colour[i]);
      fine.exg[i] =
          match_colours ? map::excessGreen(fine.colour[i], map::ExgKind::kChromatic) : own.exg[i];
      fine.mask[i] = 255;
    }
  }
  return fine;
}

}  // namespace

std::vector<std::string> writeLayers(const Place& place, const SharedMap& map,
                                     const StripPoints& points, const FuseOptions& options,
                                     const Crs& crs) {
  std::vector<std::string> names = writeWhole(place, map, crs);
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    const FusedStrip& strip = map.strips[i];
    if (strip.owned_area <= 0.0) continue;
    const map::GridMap own = fineMap(map, i, *points[i]);
    const FineLayers fine = fineLayers(map, strip, own, options.match_colours);
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
  }
  return names;
}

}  // namespace agricolmap::fuse
