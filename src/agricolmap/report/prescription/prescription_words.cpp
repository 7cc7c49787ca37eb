#include "agricolmap/report/prescription/prescription_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "agricolmap/report/draw/ramp.hpp"

namespace agricolmap::report {

namespace {

using Json = nlohmann::ordered_json;
using prescribe::ClassShare;

std::size_t unknownSquares(const prescribe::Plan& plan) {
  std::size_t known = 0;
  for (const ClassShare& share : plan.classes) known += share.squares;
  return plan.code.size() - known;
}

Json classJson(const PlacedPlan& placed, std::size_t index) {
  const prescribe::Plan& plan = placed.plan;
  const ClassShare& share = plan.classes[index];
  return {{"class", index + 1},
          {"from", index == 0 ? Json(nullptr) : Json(plan.breaks[index - 1])},
          {"to", index == plan.breaks.size() ? Json(nullptr) : Json(plan.breaks[index])},
          {"rate", share.rate},
          {"task_value", share.task_value},
          {"task_rate", prescribe::taskRate(share.task_value, plan.unit)},
          {"squares", share.squares},
          {"area_m2", share.area},
          {"amount", share.amount}};
}

Json gridJson(const PlacedPlan& placed) {
  const prescribe::Lattice& lattice = placed.grid.lattice;
  return {{"type", placed.kind == prescribe::GridKind::kValues ? 2 : 1},
          {"ddi", placed.plan.unit.ddi},
          {"south_deg", lattice.corner.y()},
          {"west_deg", lattice.corner.x()},
          {"cell_north_deg", lattice.axes(1, 1)},
          {"cell_east_deg", lattice.axes(0, 0)},
          {"rows", lattice.rows},
          {"cols", lattice.cols},
          {"amount", placed.grid.amount}};
}

}  // namespace

std::string classRange(const PlacedPlan& placed, std::size_t index) {
  const std::vector<double>& breaks = placed.plan.breaks;
  const std::string unit = placed.unit.empty() ? "" : " " + placed.unit;
  if (breaks.empty()) return "all";
  if (index == 0) return fmt::format("below {:.4g}{}", breaks.front(), unit);
  if (index == breaks.size()) return fmt::format("from {:.4g}{}", breaks.back(), unit);
  return fmt::format("{:.4g} to {:.4g}{}", breaks[index - 1], breaks[index], unit);
}

std::string amountText(double amount, const prescribe::RateUnit& unit) {
  return amount < 1e4 ? fmt::format("{:.4g} {}", amount, unit.amount)
                      : fmt::format("{:.0f} {}", amount, unit.amount);
}

std::uint32_t classColour(const prescribe::Plan& plan, std::size_t index) {
  constexpr std::uint32_t kNothing = 0xc3c7cd;
  if (plan.classes[index].task_value == 0) return kNothing;
  const double last = std::max(1.0, static_cast<double>(plan.classes.size()) - 1.0);
  return rampColour(kLowToHigh, static_cast<double>(index) / last);
}

io::VectorLayer prescriptionLayer(const PlacedPlan& placed,
                                  const prescribe::Earth::Turn& degrees_from_file) {
  using io::FieldKind;
  const prescribe::Plan& plan = placed.plan;
  io::VectorLayer layer{"prescription",
                        io::GeometryKind::kPolygon,
                        {{"CLASS", FieldKind::kInteger},
                         {"RATE", FieldKind::kReal, 4},
                         {"UNIT", FieldKind::kText},
                         {"PRODUCT", FieldKind::kText},
                         {"AREA_M2", FieldKind::kReal, 2},
                         {"AMOUNT", FieldKind::kReal, 4}},
                        {}};
  Eigen::Affine2d plane_from_cell = Eigen::Affine2d::Identity();
  plane_from_cell.linear() = plan.lattice.axes;
  plane_from_cell.translation() = plan.lattice.corner;
  const auto degrees = [&](const std::vector<Eigen::Vector2d>& points) {
    return plan.lattice.in_degrees ? points : degrees_from_file(points);
  };
  for (const io::CodePolygon& polygon : io::codePolygons(plan.code, plane_from_cell)) {
    const ClassShare& share = plan.classes[static_cast<std::size_t>(polygon.code) - 1];
    io::VectorFeature feature;
    feature.points = degrees(polygon.outline);
    for (const auto& hole : polygon.holes) feature.holes.push_back(degrees(hole));
    const double area = prescribe::polygonArea(feature.points, feature.holes);
    const double rate = prescribe::taskRate(share.task_value, plan.unit);
    feature.values = {std::int64_t{polygon.code},
                      rate,
                      std::string(plan.unit.name),
                      placed.product,
                      area,
                      prescribe::amountOn(area, rate, plan.unit)};
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

nlohmann::ordered_json prescriptionJson(const PlacedPlan& placed) {
  const prescribe::Plan& plan = placed.plan;
  Json json = {{"format", "agricolmap-prescription"},
               {"format_version", 1},
               {"source", placed.source},
               {"layer", placed.layer},
               {"layer_unit", placed.unit},
               {"crs", placed.crs.name},
               {"product", placed.product},
               {"rate_unit", plan.unit.name},
               {"amount_unit", plan.unit.amount}};
  json["squares"] = {
      {"width_m", placed.squares.width},
      {"length_m", placed.squares.length},
      {"heading_deg", placed.heading_deg ? Json(*placed.heading_deg) : Json(nullptr)},
      {"rows", plan.lattice.rows},
      {"cols", plan.lattice.cols},
      {"without_rate", unknownSquares(plan)}};
  json["classes"] = Json::array();
  for (std::size_t i = 0; i < plan.classes.size(); ++i) {
    json["classes"].push_back(classJson(placed, i));
  }
  json["total"] = {{"area_m2", plan.area}, {"amount", plan.amount}};
  json["isoxml_grid"] = gridJson(placed);
  return json;
}

std::string prescriptionText(const PlacedPlan& placed) {
  const prescribe::Plan& plan = placed.plan;
  std::string text =
      fmt::format("{} of {}: {} classes in squares of {:g} x {:g} m\n", placed.layer, placed.source,
                  plan.classes.size(), placed.squares.width, placed.squares.length);
  for (std::size_t i = 0; i < plan.classes.size(); ++i) {
    const ClassShare& share = plan.classes[i];
    text += fmt::format("{:<22} {:>9.1f} m2  {:>10.6g} {:<9} {:>12}\n", classRange(placed, i),
                        share.area, prescribe::taskRate(share.task_value, plan.unit),
                        plan.unit.name, amountText(share.amount, plan.unit));
  }
  text += fmt::format("{:<22} {:>9.1f} m2  {:>10} {:<9} {:>12}\n", "all", plan.area, "", "",
                      amountText(plan.amount, plan.unit));
  return text;
}

}  // namespace agricolmap::report
