#include "agricolmap/report/facts/facts_layers.hpp"

#include <cmath>
#include <limits>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/report/gis/qgis_style.hpp"

namespace agricolmap::report {

namespace {

using io::FieldKind;
using io::GeometryKind;
using io::VectorFeature;
using io::VectorLayer;
using io::VectorValue;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::int64_t number(std::size_t value) { return static_cast<std::int64_t>(value); }

void addStandFields(VectorLayer& layer, bool countable) {
  const auto real = [&](const char* name, int decimals) {
    layer.fields.push_back({name, FieldKind::kReal, decimals});
  };
  real("seen_m2", 2);
  real("cover", 4);
  real("weed_share", 5);
  layer.fields.push_back({"weed_patches", FieldKind::kInteger});
  real("weed_patches_per_m2", 3);
  real("row_m", 2);
  if (countable) {
    real("plants", 1);
    real("plants_low", 1);
    real("plants_high", 1);
    layer.fields.push_back({"plants_counted", FieldKind::kInteger});
    real("uncounted_row_m", 2);
    real("plants_per_row_m", 3);
    layer.fields.push_back({"gaps", FieldKind::kInteger});
    real("gap_m", 2);
  }
  real("height_p10_m", 3);
  real("height_p50_m", 3);
  real("height_p90_m", 3);
}

void addStandValues(const crop::StandFacts& facts, bool countable,
                    std::vector<VectorValue>& values) {
  values.insert(values.end(),
                {facts.area, facts.cover, facts.weeds, number(facts.patches),
                 facts.between > 0.0 ? static_cast<double>(facts.patches) / facts.between : kNone,
                 facts.row_length});
  if (countable) {
    values.insert(values.end(), {facts.plants, facts.plants_low, facts.plants_high,
                                 number(facts.counted), facts.uncounted,
                                 facts.row_length > 0.0 ? facts.plants / facts.row_length : kNone,
                                 number(facts.gaps), facts.gap_length});
  }
  values.insert(values.end(), {facts.height.low, facts.height.middle, facts.height.high});
}

/// Points of a row between two places along it, and those places themselves.
std::vector<Eigen::Vector2d> piece(const crop::RowLine& line, const crop::Stretch& stretch,
                                   const Eigen::Vector2d& origin) {
  std::vector<Eigen::Vector2d> points = {origin + line.at(stretch.from).point};
  double along = 0.0;
  for (std::size_t i = 0; i < line.points().size(); ++i) {
    if (i > 0) along += (line.points()[i] - line.points()[i - 1]).norm();
    if (along > stretch.from && along < stretch.to) points.push_back(origin + line.points()[i]);
  }
  points.push_back(origin + line.at(stretch.to).point);
  return points;
}

VectorLayer rowsLayer(const PlacedFacts& placed) {
  const crop::FieldFacts& facts = placed.facts;
  VectorLayer layer{"rows", GeometryKind::kLine, {{"id", FieldKind::kInteger}}, {}};
  layer.fields.push_back({"length_m", FieldKind::kReal, 3});
  layer.fields.push_back({"heading_deg", FieldKind::kReal, 2});
  addStandFields(layer, facts.countable);
  for (std::size_t i = 0; i < facts.rows.rows.size(); ++i) {
    const crop::RowLine& line = facts.rows.rows[i].line;
    const Eigen::Vector2d along = line.points().back() - line.points().front();
    VectorFeature row{piece(line, {0.0, line.length()}, placed.origin), {number(i + 1)}};
    row.values.emplace_back(line.length());
    row.values.emplace_back(degrees(std::atan2(along.y(), along.x())));
    addStandValues(facts.per_row[i], facts.countable, row.values);
    layer.features.push_back(std::move(row));
  }
  return layer;
}

VectorLayer plantsLayer(const PlacedFacts& placed) {
  VectorLayer layer{"plants",
                    GeometryKind::kPoint,
                    {{"id", FieldKind::kInteger},
                     {"row", FieldKind::kInteger},
                     {"along_m", FieldKind::kReal, 3},
                     {"height_m", FieldKind::kReal, 3},
                     {"area_m2", FieldKind::kReal, 5},
                     {"certainty", FieldKind::kReal, 2}},
                    {}};
  std::int64_t id = 0;
  for (std::size_t i = 0; i < placed.facts.rows.rows.size(); ++i) {
    for (const crop::CropPlant& plant : placed.facts.rows.rows[i].stand.plants) {
      layer.features.push_back(
          {{placed.origin + plant.place},
           {++id, number(i + 1), plant.along, plant.height, plant.area, plant.certainty}});
    }
  }
  return layer;
}

/// Pieces of rows: gaps, or what could not be counted.
VectorLayer stretchesLayer(const PlacedFacts& placed, const char* name,
                           std::vector<crop::Stretch> crop::RowPlants::*which) {
  VectorLayer layer{name,
                    GeometryKind::kLine,
                    {{"id", FieldKind::kInteger},
                     {"row", FieldKind::kInteger},
                     {"from_m", FieldKind::kReal, 3},
                     {"to_m", FieldKind::kReal, 3},
                     {"length_m", FieldKind::kReal, 3},
                     {"spacings", FieldKind::kReal, 2},
                     {"x", FieldKind::kReal, 3},
                     {"y", FieldKind::kReal, 3}},
                    {}};
  const double distance = placed.facts.rows.spacing.distance;
  std::int64_t id = 0;
  for (std::size_t i = 0; i < placed.facts.rows.rows.size(); ++i) {
    const crop::FieldRow& row = placed.facts.rows.rows[i];
    for (const crop::Stretch& stretch : row.stand.*which) {
      const Eigen::Vector2d middle =
          placed.origin + row.line.at(0.5 * (stretch.from + stretch.to)).point;
      layer.features.push_back(
          {piece(row.line, stretch, placed.origin),
           {++id, number(i + 1), stretch.from, stretch.to, stretch.length(),
            distance > 0.0 ? stretch.length() / distance : kNone, middle.x(), middle.y()}});
    }
  }
  return layer;
}

VectorLayer weedsLayer(const PlacedFacts& placed) {
  VectorLayer layer{"weeds",
                    GeometryKind::kPoint,
                    {{"id", FieldKind::kInteger}, {"area_m2", FieldKind::kReal, 5}},
                    {}};
  std::int64_t id = 0;
  for (const crop::WeedPatch& patch : placed.facts.weeds.patches) {
    layer.features.push_back({{placed.origin + patch.place}, {++id, patch.area}});
  }
  return layer;
}

VectorLayer gridLayer(const PlacedFacts& placed) {
  VectorLayer layer{"grid",
                    GeometryKind::kPolygon,
                    {{"id", FieldKind::kInteger},
                     {"x_west", FieldKind::kReal, 3},
                     {"y_south", FieldKind::kReal, 3}},
                    {}};
  addStandFields(layer, placed.facts.countable);
  std::int64_t id = 0;
  for (const crop::GridSquare& square : placed.facts.grid) {
    const Eigen::Vector2d a = placed.origin + square.corner;
    const Eigen::Vector2d b = a + Eigen::Vector2d::Constant(square.side);
    VectorFeature feature{{a, {b.x(), a.y()}, b, {a.x(), b.y()}}, {++id, a.x(), a.y()}};
    addStandValues(square.facts, placed.facts.countable, feature.values);
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

VectorLayer plotsLayer(const PlacedFacts& placed) {
  VectorLayer layer{"plots", GeometryKind::kPolygon, {{"id", FieldKind::kText}}, {}};
  addStandFields(layer, placed.facts.countable);
  for (std::size_t i = 0; i < placed.plots.size(); ++i) {
    VectorFeature feature{{}, {placed.plots[i].id}};
    for (const Eigen::Vector2d& p : placed.plots[i].corners) {
      feature.points.push_back(placed.origin + p);
    }
    addStandValues(placed.facts.per_plot[i], placed.facts.countable, feature.values);
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

}  // namespace

std::vector<io::VectorLayer> factsLayers(const PlacedFacts& placed) {
  std::vector<io::VectorLayer> layers = {
      rowsLayer(placed),
      plantsLayer(placed),
      stretchesLayer(placed, "gaps", &crop::RowPlants::gaps),
      weedsLayer(placed),
      stretchesLayer(placed, "uncountable", &crop::RowPlants::touching),
      gridLayer(placed)};
  if (!placed.plots.empty()) layers.push_back(plotsLayer(placed));
  for (VectorLayer& layer : layers) layer.qgis_style = qgisMarks(layer.name);
  return layers;
}

}  // namespace agricolmap::report
