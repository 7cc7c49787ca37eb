#include "agricolmap/crop/facts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/api/checks.hpp"
#include "agricolmap/api/field_rasters.hpp"
#include "agricolmap/api/settings.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/crop/field_layers.hpp"
#include "agricolmap/crop/fine_strips.hpp"
#include "agricolmap/field.hpp"

namespace agricolmap {
namespace {

CropFacts::Stand standOf(const crop::StandFacts& inside) {
  CropFacts::Stand stand;
  stand.area_m2 = inside.area;
  stand.cover = inside.cover;
  stand.weeds = inside.weeds;
  stand.patches = inside.patches;
  stand.row_length_m = inside.row_length;
  stand.plants = inside.plants;
  stand.plants_low = inside.plants_low;
  stand.plants_high = inside.plants_high;
  stand.counted = inside.counted;
  stand.uncounted_m = inside.uncounted;
  stand.gaps = inside.gaps;
  stand.gap_length_m = inside.gap_length;
  stand.height_low_m = inside.height.low;
  stand.height_middle_m = inside.height.middle;
  stand.height_high_m = inside.height.high;
  return stand;
}

void addRow(const crop::FieldRow& row, const crop::StandFacts& stand, const Eigen::Vector2d& origin,
            CropFacts& facts) {
  const std::size_t index = facts.rows.size();
  CropFacts::Row& added = facts.rows.emplace_back();
  for (const Eigen::Vector2d& point : row.line.points()) added.line.push_back(origin + point);
  added.stand = standOf(stand);
  for (const crop::CropPlant& plant : row.stand.plants) {
    facts.plants.push_back(
        {origin + plant.place, index, plant.along, plant.area, plant.height, plant.certainty});
  }
  for (const crop::Stretch& gap : row.stand.gaps) {
    const Eigen::Vector2d middle = row.line.at(0.5 * (gap.from + gap.to)).point;
    facts.gaps.push_back({origin + middle, index, gap.from, gap.to});
  }
}

CropFacts publicFacts(const crop::FieldFacts& inside, const Eigen::Vector2d& origin) {
  CropFacts facts;
  facts.countable = inside.countable;
  facts.row_spacing_m = inside.rows.row_spacing;
  facts.row_heading_deg = degrees(inside.rows.heading);
  facts.plant_spacing_m = inside.rows.spacing.distance;
  facts.total = standOf(inside.total);
  for (std::size_t i = 0; i < inside.rows.rows.size(); ++i) {
    addRow(inside.rows.rows[i], inside.per_row[i], origin, facts);
  }
  for (const crop::WeedPatch& patch : inside.weeds.patches) {
    facts.weeds.push_back({origin + patch.place, patch.area});
  }
  for (const crop::GridSquare& square : inside.grid) {
    facts.squares.push_back({origin + square.corner, square.side, standOf(square.facts)});
  }
  for (const crop::StandFacts& plot : inside.per_plot) facts.plots.push_back(standOf(plot));
  return facts;
}

CropFacts factsOf(const std::string& name, crop::FieldLayers layers,
                  const crop::FactsOptions& options, const std::vector<Plot>& plots) {
  const std::vector<crop::Plot> inside = plotsAbout(layers.origin, plots);
  crop::bringToGround(layers, options.vegetation);
  const crop::FieldFacts found = crop::factsOf(layers.view(), layers.origin, inside, options);
  if (!found.greenness.known()) {
    throw InputError(fmt::format("{}: no crop facts: {}", name,
                                 map::toString(found.greenness.threshold.status)));
  }
  // Plots of another field would count nothing and look as if nothing stood there.
  const auto shown = [](const crop::StandFacts& plot) { return plot.area > 0.0; };
  if (!plots.empty() && std::none_of(found.per_plot.begin(), found.per_plot.end(), shown)) {
    throw InputError(fmt::format(
        "{}: shows nothing of the {} plots; give those of this field, in its coordinates", name,
        plots.size()));
  }
  return publicFacts(found, layers.origin);
}

crop::FieldLayers layersOf(const FieldMap& map) {
  crop::FieldLayers layers;
  layers.origin = originOf(map);
  layers.frame = frameOf(map, layers.origin);
  layers.exg = rasterOf(map.rows, map.cols, map.excess_green, "excess_green");
  if (map.has_heights) {
    layers.height = rasterOf(map.rows, map.cols, map.plant_height_m, "plant_height_m");
  }
  layers.above_ground = true;
  std::vector<crop::FineStrip> strips;
  for (const FieldMap::Strip& strip : map.strips) {
    const FieldMap::Fine& fine = strip.fine;
    if (fine.rows == 0) continue;
    const Eigen::Vector2d corner = fine.file_from_cell.translation().head<2>();
    const auto raster = [&](const std::vector<float>& values, const char* layer) {
      return rasterOf(fine.rows, fine.cols, values, strip.name + "'s " + layer);
    };
    strips.push_back({{corner - layers.origin, fine.cell_m, fine.rows, fine.cols},
                      raster(fine.excess_green, "excess_green"),
                      raster(fine.plant_height_m, "plant_height_m")});
  }
  crop::refine(layers, strips);
  return layers;
}

}  // namespace

std::vector<OptionInfo> factsOptions() {
  crop::FactsOptions options;
  return infosOf(optionTable(options));
}

CropFacts cropFacts(const Cloud& cloud, const Settings& options, const std::vector<Plot>& plots,
                    const Control& control) {
  requireProcessor();
  requireWhole(cloud);
  const auto in_force = chosen<crop::FactsOptions>(options);
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  return factsOf(cloud.name, crop::layersOf(CloudStream(cloud)), in_force, plots);
}

CropFacts cropFacts(const FieldMap& map, const Settings& options, const std::vector<Plot>& plots,
                    const Control& control) {
  requireProcessor();
  const auto in_force = chosen<crop::FactsOptions>(options);
  const ThreadLimit limit = threadLimit(control);
  const StopScope scope(control.stop);
  return factsOf("the map", layersOf(map), in_force, plots);
}

}  // namespace agricolmap
