#include "agricolmap/change.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "agricolmap/api/checks.hpp"
#include "agricolmap/api/field_rasters.hpp"
#include "agricolmap/change/common_grid.hpp"
#include "agricolmap/change/comparison.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/crop/zones.hpp"

namespace agricolmap {
namespace {

FieldChange::Share shareOf(const change::Share& inside) {
  const double half = change::kLevel95 * inside.deviation;
  return {inside.cells,         inside.area,   inside.volume,          inside.volume - half,
          inside.volume + half, inside.mean(), inside.meanDeviation(), inside.median};
}

template <typename Inside>
FieldChange::Layer layerOf(const Inside& inside) {
  return {inside.cells, inside.before, inside.after};
}

FieldChange::Part partOf(const change::PartChange& inside, const change::Comparison& compared) {
  FieldChange::Part part;
  part.compared_m2 = inside.area;
  part.compared = shareOf(inside.heights.compared);
  part.rise = shareOf(inside.heights.rise);
  part.fall = shareOf(inside.heights.fall);
  part.level_m = inside.level();
  part.more_than_errors = inside.moreThanErrors();
  if (compared.plant_height) part.plant_height = layerOf(inside.plant_height);
  if (compared.cover) part.cover = layerOf(inside.cover);
  return part;
}

void requireSettings(const DiffSettings& settings) {
  const auto check = [](const std::optional<MapError>& error, const char* of) {
    const auto fits = [](double value) { return value >= 0.0 && value <= change::kMostError; };
    if (!error || (fits(error->height_m) && fits(error->plane_m))) return;
    throw UsageError(
        fmt::format("{}: is {:g}, {:g}; must be heights and places, each from 0 to {:g} m", of,
                    error->height_m, error->plane_m, change::kMostError));
  };
  check(settings.error_a, "error_a");
  check(settings.error_b, "error_b");
  check(settings.frame_error, "frame_error");
  const double side = settings.grid_m;
  if (side == 0.0 || (side >= change::kLeastSquare && side <= change::kMostSquare)) return;
  throw UsageError(fmt::format("grid: is {:g} m; must be from {:g} to {:g} m, or 0 for none", side,
                               change::kLeastSquare, change::kMostSquare));
}

/// As of a surface model, which has heights alone.
void requireErrors(const FieldMap& map, const std::optional<MapError>& given,
                   const std::string& which) {
  const auto unknown = [](float error) { return std::isnan(error); };
  if (given || !map.has_heights || !std::ranges::all_of(map.height_error_m, unknown)) return;
  throw UsageError(
      fmt::format("map_{0}: nothing is known of its errors; say which RMS is expected of its "
                  "heights and places, in metres: error_{0}",
                  which));
}

/// One system has many texts, so names decide where these differ; but one name may have two, too.
void requireSameCrs(const Crs& a, const Crs& b, bool known, std::vector<std::string>& warnings) {
  if (known) return;
  const bool named = !a.name.empty() && !b.name.empty();
  if (named && a.name != b.name && (a.wkt.empty() || a.wkt != b.wkt)) {
    throw InputError(fmt::format(
        "the maps have different coordinate systems, {} and {}; bring one into the other's", a.name,
        b.name));
  }
  if (a.wkt.empty() != b.wkt.empty()) {
    warnings.push_back(
        fmt::format("the coordinate system of the {} map is not known; taken to be the other's",
                    a.wkt.empty() ? "first" : "second"));
  } else if (a.wkt != b.wkt) {
    warnings.push_back(fmt::format(
        "the coordinate systems of the maps are told in different words; taken to be one, {}",
        a.name.empty() ? b.name : a.name));
  }
}

/// What two drone's maps lie apart is in no map's errors.
void warnOfFrames(const FieldMap& a, const FieldMap& b, const DiffSettings& settings,
                  std::vector<std::string>& warnings) {
  if (settings.frame_error || !a.has_heights || !b.has_heights || a.fixed == b.fixed) return;
  // A surface model has no cloud: what is said of its errors holds its frame's.
  if (a.fixed.points == 0 || b.fixed.points == 0) return;
  warnings.emplace_back(
      "the maps do not hang on one fixed cloud, and what two of them lie apart is in neither's "
      "errors; say what is expected of it, in metres: frame_error");
}

/// Where two maps are compared.
struct Ground {
  GridFrame frame;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
  /// Heights are compared above the first map's zero: near it, floats have digits to spare.
  double zero = 0.0;
};

/// Nothing where no cell has a value.
std::optional<Raster<float>> layerOn(const FieldMap& map, const std::vector<float>& values,
                                     const char* name, const Ground& ground) {
  if (std::ranges::all_of(values, [](float value) { return std::isnan(value); })) {
    return std::nullopt;
  }
  return change::areaMean(rasterOf(map.rows, map.cols, values, name), frameOf(map, ground.origin),
                          ground.frame);
}

change::MapHeights heightsOn(const FieldMap& map, const std::optional<MapError>& given,
                             const Ground& ground) {
  const GridFrame own = frameOf(map, ground.origin);
  const GridFrame& to = ground.frame;
  Raster<float> surface = rasterOf(map.rows, map.cols, map.surface_m, "surface_m");
  const double lift = map.file_from_cell.translation().z() - ground.zero;
  for (float& height : surface) height = static_cast<float>(static_cast<double>(height) + lift);
  change::MapHeights heights;
  heights.surface = change::areaMean(surface, own, to);
  if (given) {
    heights.plane_error = Raster<float>(to.rows, to.cols, static_cast<float>(given->plane_m));
    heights.height_error = Raster<float>(to.rows, to.cols, static_cast<float>(given->height_m));
  } else {
    const auto error = [&](const std::vector<float>& values, const char* name) {
      return change::areaRms(rasterOf(map.rows, map.cols, values, name), own, to);
    };
    heights.plane_error = error(map.plane_error_m, "plane_error_m");
    heights.height_error = error(map.height_error_m, "height_error_m");
  }
  heights.source = change::nearestCode(rasterOf(map.rows, map.cols, map.source, "source"), own, to);
  return heights;
}

change::MapLayers layersOn(const FieldMap& map, const std::optional<MapError>& given,
                           const Ground& ground, bool flat) {
  change::MapLayers layers{flat ? change::noHeights(ground.frame) : heightsOn(map, given, ground)};
  layers.cover = layerOn(map, map.cover, "cover", ground);
  if (!flat) layers.plant_height = layerOn(map, map.plant_height_m, "plant_height_m", ground);
  return layers;
}

Ground groundOf(const FieldMap& a, const FieldMap& b) {
  Ground ground;
  ground.origin = originOf(a);
  ground.zero = a.file_from_cell.translation().z();
  const auto frame = change::commonGrid(frameOf(a, ground.origin), frameOf(b, ground.origin));
  if (!frame) {
    throw InputError("the maps do not overlap by a whole cell; compare maps of one field");
  }
  ground.frame = *frame;
  return ground;
}

void addParts(const change::Comparison& compared, const DiffSettings& settings,
              const Ground& ground, FieldChange& found) {
  if (!settings.plots.empty()) {
    const crop::Zones zones =
        crop::plotZones(ground.frame, plotsAbout(ground.origin, settings.plots));
    for (const auto& part : change::partChanges(compared, zones, settings.plots.size())) {
      found.plots.push_back(partOf(part, compared));
    }
    // Plots of another field would look as if nothing had changed there.
    const auto shown = [](const FieldChange::Part& part) { return part.compared_m2 > 0.0; };
    if (std::ranges::none_of(found.plots, shown)) {
      throw InputError(fmt::format(
          "the maps have nothing to compare in any of the {} plots; give those of this field, in "
          "its coordinates",
          settings.plots.size()));
    }
  }
  if (settings.grid_m <= 0.0) return;
  std::vector<crop::GridSquare> squares;
  const crop::Zones zones =
      crop::squareZones(ground.frame, ground.origin, settings.grid_m, squares);
  const auto parts = change::partChanges(compared, zones, squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i) {
    if (parts[i].area == 0.0) continue;
    found.squares.push_back(
        {ground.origin + squares[i].corner, settings.grid_m, partOf(parts[i], compared)});
  }
}

FieldChange publicChange(const change::Comparison& compared, const Ground& ground) {
  FieldChange found;
  const GridFrame& frame = ground.frame;
  found.rows = frame.rows;
  found.cols = frame.cols;
  found.cell_m = frame.cell;
  found.file_from_cell =
      fileFromCell(frame, Eigen::Vector3d(ground.origin.x(), ground.origin.y(), 0.0));
  found.has_heights = !compared.flat;
  found.height_change_m = valuesOf(compared.heights.change);
  found.detection_m = valuesOf(compared.heights.detection);
  const Raster<float>& significant = compared.heights.significant;
  std::ranges::transform(significant, std::back_inserter(found.significant),
                         [](float value) { return static_cast<std::uint8_t>(value > 0.0F); });
  if (compared.plant_height) {
    found.plant_height_change_m = valuesOf(compared.plant_height->change);
    found.plant_height = layerOf(*compared.plant_height);
  }
  if (compared.cover) {
    found.cover_change = valuesOf(compared.cover->change);
    found.cover = layerOf(*compared.cover);
  }
  found.frame_error = {compared.frames.height, compared.frames.plane};
  found.compared = shareOf(compared.totals.compared);
  found.rise = shareOf(compared.totals.rise);
  found.fall = shareOf(compared.totals.fall);
  found.median_detection_m = compared.totals.median_detection;
  if (compared.totals.stable && !compared.flat) {
    found.bare_ground = shareOf(*compared.totals.stable);
  }
  return found;
}

}  // namespace

FieldChange diffMaps(const FieldMap& map_a, const FieldMap& map_b, const DiffSettings& settings,
                     const Control& control) {
  requireProcessor();
  requireSettings(settings);
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  std::vector<std::string> warnings;
  requireSameCrs(map_a.crs, map_b.crs, settings.same_crs, warnings);
  requireErrors(map_a, settings.error_a, "a");
  requireErrors(map_b, settings.error_b, "b");
  warnOfFrames(map_a, map_b, settings, warnings);
  const bool flat = !map_a.has_heights || !map_b.has_heights;
  if (map_a.has_heights != map_b.has_heights) {
    warnings.emplace_back("one of the maps has no heights, so only greenness is compared");
  }
  const Ground ground = groundOf(map_a, map_b);
  const MapError frames = settings.frame_error.value_or(MapError{});
  const change::Comparison compared =
      change::compareMaps(layersOn(map_a, settings.error_a, ground, flat),
                          layersOn(map_b, settings.error_b, ground, flat), ground.frame.cell,
                          {.plane = frames.plane_m, .height = frames.height_m}, flat);
  throwIfInterrupted();
  if (compared.comparedCells() == 0) {
    throw InputError(fmt::format("the maps have no cell in common of which both know {}",
                                 flat ? "the cover" : "the surface and its error"));
  }
  FieldChange found = publicChange(compared, ground);
  found.crs = map_a.crs.wkt.empty() ? map_b.crs : map_a.crs;
  addParts(compared, settings, ground, found);
  if (const auto moved = change::bareGroundWarning(compared.totals); !moved.empty()) {
    warnings.push_back(moved);
  }
  found.warnings = std::move(warnings);
  return found;
}

}  // namespace agricolmap
