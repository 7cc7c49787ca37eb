#include "change_zones.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "agricolmap/change/distribution.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/crop/zones.hpp"
#include "agricolmap/report/gis/qgis_style.hpp"

namespace agricolmap {
namespace {

Crs crsOf(const std::string& wkt) {
  Crs crs;
  crs.wkt = wkt;
  return crs;
}

/// A part of the field.
struct Zone {
  std::string id;
  std::vector<Eigen::Vector2d> corners;  ///< file coordinates
};

io::VectorLayer emptyLayer(const char* name, const MapChange& found) {
  io::VectorLayer layer;
  layer.name = name;
  layer.kind = io::GeometryKind::kPolygon;
  layer.fields = {{"id", io::FieldKind::kText}};
  const auto real = [&](const char* field, int decimals) {
    layer.fields.push_back({field, io::FieldKind::kReal, decimals});
  };
  real("compared_m2", 2);
  if (!found.compared.flat) {
    real("height_change_m", 4);
    real("height_change_level_m", 4);
    layer.fields.push_back({"more_than_errors", io::FieldKind::kInteger});
    real("rose_share", 4);
    real("fell_share", 4);
    real("volume_m3", 4);
    real("volume_low_m3", 4);
    real("volume_high_m3", 4);
  }
  if (found.compared.plant_height) {
    real("plant_height_before_m", 3);
    real("plant_height_after_m", 3);
  }
  if (found.compared.cover) {
    real("cover_before", 4);
    real("cover_after", 4);
  }
  return layer;
}

void addHeights(const change::PartChange& part, std::vector<io::VectorValue>& values) {
  const change::Share& all = part.heights.compared;
  if (all.cells == 0) {
    values.resize(values.size() + 8);
    return;
  }
  const double half = change::kLevel95 * all.deviation;
  values.insert(values.end(), {all.mean(), part.level()});
  values.emplace_back(std::int64_t{part.moreThanErrors() ? 1 : 0});
  values.insert(values.end(), {part.heights.rise.area / all.area, part.heights.fall.area / all.area,
                               all.volume, all.volume - half, all.volume + half});
}

std::vector<io::VectorValue> valuesOf(const Zone& zone, const change::PartChange& part,
                                      const change::Comparison& compared) {
  std::vector<io::VectorValue> values = {zone.id, part.area};
  if (!compared.flat) addHeights(part, values);
  if (compared.plant_height) {
    values.insert(values.end(), {part.plant_height.before, part.plant_height.after});
  }
  if (compared.cover) values.insert(values.end(), {part.cover.before, part.cover.after});
  return values;
}

/// As the change of the surface, of flat maps of the cover, reaches.
std::string styleOf(const std::vector<change::PartChange>& parts,
                    const change::Comparison& compared) {
  Raster<float> changes(1, static_cast<int>(parts.size()), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].area == 0.0) continue;
    changes[i] = static_cast<float>(compared.flat ? parts[i].cover.after - parts[i].cover.before
                                                  : parts[i].heights.compared.mean());
  }
  if (compared.flat) {
    return report::qgisChange({.change = "\"cover_after\" - \"cover_before\"",
                               .reach = change::reachOf(changes),
                               .factor = 100.0,
                               .unit = "%"});
  }
  return report::qgisChange({.change = "\"height_change_m\"",
                             .sure = "\"more_than_errors\"",
                             .reach = change::reachOf(changes),
                             .factor = 100.0,
                             .unit = "cm"});
}

/// `whole`: also parts of which the maps know nothing.
io::VectorLayer layerOf(const char* name, const std::vector<Zone>& zones,
                        const crop::Zones& numbers, bool whole, const MapChange& found) {
  const std::vector<change::PartChange> parts =
      change::partChanges(found.compared, numbers, zones.size());
  io::VectorLayer layer = emptyLayer(name, found);
  layer.qgis_style = styleOf(parts, found.compared);
  for (std::size_t i = 0; i < zones.size(); ++i) {
    if (!whole && parts[i].area == 0.0) continue;
    layer.features.push_back({zones[i].corners, valuesOf(zones[i], parts[i], found.compared)});
  }
  return layer;
}

io::VectorLayer byPlots(const std::string& path, const MapChange& found) {
  const Eigen::Vector2d origin = found.ground.origin.head<2>();
  std::vector<Zone> zones;
  std::vector<crop::Plot> plots;
  for (io::NamedPolygon& polygon : io::readPolygons(path, crsOf(found.ground.crs))) {
    zones.push_back({polygon.id, polygon.corners});
    for (Eigen::Vector2d& corner : polygon.corners) corner -= origin;
    plots.push_back({std::move(polygon.id), std::move(polygon.corners)});
  }
  io::VectorLayer layer =
      layerOf("plots", zones, crop::plotZones(found.ground.frame, plots), true, found);
  // Their area, after the id.
  const bool any = std::ranges::any_of(layer.features, [](const io::VectorFeature& feature) {
    return std::get<double>(feature.values[1]) > 0.0;
  });
  if (!any) {
    throw InputError(
        fmt::format("{}: the maps have nothing to compare in any of its {} plots; give those of "
                    "this field, and "
                    "see that their coordinate system is the one that the file says",
                    path, zones.size()));
  }
  return layer;
}

io::VectorLayer bySquares(double side, const MapChange& found) {
  const Eigen::Vector2d origin = found.ground.origin.head<2>();
  std::vector<crop::GridSquare> squares;
  const crop::Zones numbers = crop::squareZones(found.ground.frame, origin, side, squares);
  std::vector<Zone> zones;
  for (const crop::GridSquare& square : squares) {
    const Eigen::Vector2d low = origin + square.corner;
    zones.push_back({fmt::format("{:.0f}_{:.0f}", low.x() / side, low.y() / side),
                     {low, low + Eigen::Vector2d(side, 0.0), low + Eigen::Vector2d(side, side),
                      low + Eigen::Vector2d(0.0, side)}});
  }
  return layerOf("grid", zones, numbers, false, found);
}

}  // namespace

std::vector<io::VectorLayer> changeByZones(const ZonesAsked& asked, const MapChange& found) {
  std::vector<io::VectorLayer> layers;
  if (!asked.plots.empty()) layers.push_back(byPlots(asked.plots, found));
  if (asked.grid > 0.0) layers.push_back(bySquares(asked.grid, found));
  return layers;
}

void writeZones(const io::OutputPath& dir, const std::vector<io::VectorLayer>& layers,
                const std::string& crs) {
  if (layers.empty()) return;
  io::writeGeoPackage(dir / "change.gpkg", layers, crsOf(crs));
  for (const io::VectorLayer& layer : layers) io::writeCsv(dir / (layer.name + ".csv"), layer);
}

}  // namespace agricolmap
