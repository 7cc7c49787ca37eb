#include <fmt/format.h>

#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/report/facts/facts_layers.hpp"

namespace agricolmap::report {

namespace {

using Json = nlohmann::ordered_json;

Json numberOrNull(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json standJson(const crop::StandFacts& facts, bool countable) {
  Json json = {{"seen_m2", facts.area},
               {"cover", facts.cover},
               {"between_rows_m2", facts.between},
               {"weed_share", facts.weeds},
               {"weed_patches", facts.patches},
               {"row_m", facts.row_length}};
  if (countable) {
    json["plants"] = {{"estimate", facts.plants},
                      {"low", facts.plants_low},
                      {"high", facts.plants_high},
                      {"counted", facts.counted},
                      {"uncounted_row_m", facts.uncounted}};
    json["gaps"] = {{"count", facts.gaps}, {"length_m", facts.gap_length}};
  } else {
    json["plants"] = nullptr;
    json["gaps"] = nullptr;
  }
  json["height_m"] = {{"p10", numberOrNull(facts.height.low)},
                      {"p50", numberOrNull(facts.height.middle)},
                      {"p90", numberOrNull(facts.height.high)}};
  return json;
}

/// A polygon in degrees with the facts of what grows in it.
Json observationUnit(const PlacedFacts& placed, const std::string& id, const char* level,
                     std::vector<Eigen::Vector2d> corners, const crop::StandFacts& facts) {
  for (Eigen::Vector2d& corner : corners) corner += placed.origin;
  corners.push_back(corners.front());
  const auto degrees_of = io::geographic(placed.crs, corners);
  if (!degrees_of) return nullptr;
  Json ring = Json::array();
  for (const Eigen::Vector2d& p : *degrees_of) ring.push_back({p.x(), p.y()});
  const Json geometry = {{"type", "Polygon"}, {"coordinates", Json::array({ring})}};
  Json observations = Json::array();
  const auto observe = [&](const char* name, double value) {
    if (!std::isfinite(value)) return;
    observations.push_back({{"observationUnitDbId", id},
                            {"observationVariableDbId", name},
                            {"observationVariableName", name},
                            {"value", fmt::format("{:.6g}", value)}});
  };
  if (placed.facts.countable) {
    observe("plants", facts.plants);
    observe("plants_low", facts.plants_low);
    observe("plants_high", facts.plants_high);
    observe("gaps", static_cast<double>(facts.gaps));
  }
  observe("cover", facts.cover);
  observe("weed_share", facts.weeds);
  observe("height_p10_m", facts.height.low);
  observe("height_p50_m", facts.height.middle);
  observe("height_p90_m", facts.height.high);
  const Json position = {
      {"geoCoordinates", {{"type", "Feature"}, {"geometry", geometry}, {"properties", nullptr}}},
      {"observationLevel", {{"levelName", level}, {"levelCode", id}}}};
  return {{"type", "Feature"},
          {"geometry", geometry},
          {"properties",
           {{"observationUnitDbId", id},
            {"observationUnitName", id},
            {"observationUnitPosition", position},
            {"observations", observations}}}};
}

}  // namespace

nlohmann::ordered_json factsJson(const PlacedFacts& placed) {
  const crop::FieldFacts& facts = placed.facts;
  Json json = {{"format", "agricolmap-facts"}, {"format_version", 1}, {"source", placed.source}};
  json["crs"] = placed.crs.name.empty() ? Json(nullptr) : Json(placed.crs.name);
  const map::VegetationThreshold& green = facts.greenness.threshold;
  json["vegetation"] = {{"status", map::toString(green.status)},
                        {"excess_green_threshold", green.threshold},
                        {"contrast", green.contrast}};
  json["rows"] = {{"count", facts.rows.rows.size()},
                  {"spacing_m", facts.rows.row_spacing},
                  {"heading_deg", degrees(facts.rows.heading)}};
  json["plant_spacing_m"] = facts.countable ? Json(facts.rows.spacing.distance) : Json(nullptr);
  json["total"] = standJson(facts.total, facts.countable);
  return json;
}

nlohmann::ordered_json brapiJson(const PlacedFacts& placed) {
  if (placed.crs.wkt.empty()) return nullptr;
  Json features = Json::array();
  for (std::size_t i = 0; i < placed.plots.size(); ++i) {
    features.push_back(observationUnit(placed, placed.plots[i].id, "plot", placed.plots[i].corners,
                                       placed.facts.per_plot[i]));
  }
  for (std::size_t i = 0; placed.plots.empty() && i < placed.facts.grid.size(); ++i) {
    const crop::GridSquare& square = placed.facts.grid[i];
    const Eigen::Vector2d a = square.corner;
    const Eigen::Vector2d b = a + Eigen::Vector2d::Constant(square.side);
    features.push_back(observationUnit(placed, fmt::format("square_{}", i + 1), "subplot",
                                       {a, {b.x(), a.y()}, b, {a.x(), b.y()}}, square.facts));
  }
  for (const Json& feature : features) {
    if (feature.is_null()) return nullptr;
  }
  return {{"type", "FeatureCollection"}, {"features", features}};
}

std::string factsText(const PlacedFacts& placed) {
  const crop::FieldFacts& facts = placed.facts;
  const crop::StandFacts& total = facts.total;
  if (!facts.greenness.known()) {
    return fmt::format("{}: no facts: {}\n", placed.source,
                       map::toString(facts.greenness.threshold.status));
  }
  std::string text = fmt::format("{}: {:.0f} m2 seen, {:.1f} % of it green\n", placed.source,
                                 total.area, 100.0 * total.cover);
  if (facts.rows.rows.empty()) {
    text += "no rows found: nothing to count along\n";
  } else {
    text += fmt::format("{} rows, {:.2f} m apart, {:.0f} m in all\n", facts.rows.rows.size(),
                        facts.rows.row_spacing, total.row_length);
    if (facts.countable) {
      text += fmt::format(
          "{:.0f} plants ({:.0f} to {:.0f}), {:.3f} m apart; {:.0f} m of row cannot be counted\n",
          total.plants, total.plants_low, total.plants_high, facts.rows.spacing.distance,
          total.uncounted);
      text += fmt::format("{} gaps of 1.5 spacings and more, {:.1f} m in all\n", total.gaps,
                          total.gap_length);
    } else {
      text += "plants touch or stand too close to be counted\n";
    }
    text +=
        fmt::format("weeds between the rows: {:.2f} % of the ground, {:.2f} patches per m2\n",
                    100.0 * total.weeds,
                    total.between > 0.0 ? static_cast<double>(total.patches) / total.between : 0.0);
  }
  if (std::isfinite(total.height.middle)) {
    text += fmt::format("plant height {:.2f} m (a tenth below {:.2f} m, a tenth above {:.2f} m)\n",
                        total.height.middle, total.height.low, total.height.high);
  }
  return text;
}

}  // namespace agricolmap::report
