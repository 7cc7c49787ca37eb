#include "agricolmap/control_points/control_points_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "agricolmap/io/text/number_file.hpp"

namespace agricolmap::control_points {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr std::size_t kLongestName = 24;

/// Null stands for numbers that JSON lacks.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json axes(const Eigen::Vector3d& v) { return {number(v.x()), number(v.y()), number(v.z())}; }

Json axesOrNull(const Eigen::Vector3d& v) { return v.allFinite() ? axes(v) : Json(nullptr); }

Json rotationJson(const Eigen::Vector3d& angles) {
  return {{"roll_deg", number(angles.x() * kDegPerRad)},
          {"pitch_deg", number(angles.y() * kDegPerRad)},
          {"yaw_deg", number(angles.z() * kDegPerRad)}};
}

Json partsJson(const ControlParts& parts) {
  return {{"rotation", rotationJson(parts.angles)},
          {"scales", axes(parts.scale)},
          {"shears", axes(parts.shear)}};
}

Json errorsJson(const AxisErrors& errors) {
  if (errors.count == 0) return nullptr;
  return {{"count", errors.count},
          {"rmse_x_m", number(errors.rms.x())},
          {"rmse_y_m", number(errors.rms.y())},
          {"rmse_z_m", number(errors.rms.z())},
          {"rmse_horizontal_m", number(errors.horizontal())},
          {"rmse_3d_m", number(errors.spatial())},
          {"mean_m", axes(errors.mean)}};
}

const char* useText(PairUse use) { return use == PairUse::kControl ? "control" : "check"; }

std::string quoted(const std::string& name) {
  if (name.find_first_of(",\"") == std::string::npos) return name;
  std::string result = "\"";
  for (const char c : name) {
    if (c == '"') result += '"';
    result += c;
  }
  result += '"';
  return result;
}

/// Millimetres matter, less does not; nothing for NaN.
std::string metres(double value) {
  return std::isfinite(value) ? fmt::format("{:9.4f}", value) : fmt::format("{:>9}", "-");
}

std::string tableRow(const std::string& name, std::size_t width, const std::string& use,
                     const std::array<double, 6>& values, const std::string& remark) {
  std::string row = fmt::format("{:<{}} {:<8}", name, width, use);
  for (const double value : values) row += metres(value);
  row += remark.empty() ? "\n" : fmt::format("  {}\n", remark);
  return row;
}

std::string heading(const ControlEstimate& estimate) {
  const ControlParts& parts = estimate.parts;
  const ControlParts& off = estimate.deviations;
  std::string text =
      fmt::format("scales {:.5f} ± {:.5f} along the moving file's x, {:.5f} ± {:.5f} along its y",
                  parts.scale.x(), off.scale.x(), parts.scale.y(), off.scale.y());
  if (estimate.model == ControlModel::kAffine) {
    text +=
        fmt::format(", {:.5f} ± {:.5f} along its z\nshears {:.5f} {:.5f} {:.5f}", parts.scale.z(),
                    off.scale.z(), parts.shear.x(), parts.shear.y(), parts.shear.z());
  }
  return text + fmt::format("\nrotation roll {:.4f} pitch {:.4f} yaw {:.4f} ± {:.4f} deg\n",
                            parts.angles.x() * kDegPerRad, parts.angles.y() * kDegPerRad,
                            parts.angles.z() * kDegPerRad, off.angles.z() * kDegPerRad);
}

}  // namespace

Json controlPointsJson(std::span<const ControlPair> pairs, const ControlEstimate& estimate,
                       const std::string& source) {
  Json json;
  json["format"] = "agricolmap-control-points";
  json["format_version"] = 1;
  json["source"] = source;
  json["model"] = toString(estimate.model);
  Json matrix = Json::array();
  for (Eigen::Index row = 0; row < 4; ++row) {
    const Eigen::RowVector4d r = estimate.fixed_from_moving.matrix().row(row);
    matrix.push_back({r[0], r[1], r[2], r[3]});
  }
  json["matrix"] = matrix;
  json["parts"] = partsJson(estimate.parts);
  json["deviations"] = partsJson(estimate.deviations);
  json["noise"] = {{"horizontal_m", number(estimate.sigma_horizontal)},
                   {"vertical_m", number(estimate.sigma_vertical)}};
  json["control"] = errorsJson(estimate.control);
  json["left_out"] = errorsJson(estimate.left_out);
  json["check"] = errorsJson(estimate.check);
  json["outliers"] = Json::array();
  json["pairs"] = Json::array();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PairResidual& r = estimate.residuals[i];
    if (r.outlier) json["outliers"].push_back(pairs[i].name);
    json["pairs"].push_back({{"name", pairs[i].name},
                             {"use", useText(pairs[i].use)},
                             {"outlier", r.outlier},
                             {"weight", number(r.weight)},
                             {"residual_m", axes(r.residual)},
                             {"horizontal_m", number(r.residual.head<2>().norm())},
                             {"spatial_m", number(r.residual.norm())},
                             {"left_out_m", axesOrNull(r.left_out)},
                             {"left_out_horizontal_m", number(r.left_out.head<2>().norm())},
                             {"left_out_spatial_m", number(r.left_out.norm())}});
  }
  json["warnings"] = estimate.warnings;
  return json;
}

std::string residualsCsv(std::span<const ControlPair> pairs, const ControlEstimate& estimate) {
  std::string text =
      "name,use,outlier,weight,dx_m,dy_m,dz_m,horizontal_m,spatial_m,left_out_dx_m,left_out_dy_m,"
      "left_out_dz_m,left_out_horizontal_m,left_out_spatial_m\n";
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PairResidual& r = estimate.residuals[i];
    text += fmt::format("{},{},{},{}", quoted(pairs[i].name), useText(pairs[i].use),
                        r.outlier ? "yes" : "no", io::exactText(r.weight));
    for (const Eigen::Vector3d& v : {r.residual, r.left_out}) {
      for (const double value : {v.x(), v.y(), v.z(), v.head<2>().norm(), v.norm()}) {
        text += ',';
        if (std::isfinite(value)) text += io::exactText(value);
      }
    }
    text += "\n";
  }
  return text;
}

std::string residualsTable(std::span<const ControlPair> pairs, const ControlEstimate& estimate) {
  const std::array<std::pair<const char*, const AxisErrors*>, 3> sums = {
      {{"RMSE", &estimate.control},
       {"RMSE left out", &estimate.left_out},
       {"RMSE", &estimate.check}}};
  std::size_t width = std::string_view("RMSE left out").size();
  for (const ControlPair& pair : pairs) width = std::max(width, pair.name.size());
  width = std::min(width, kLongestName);
  std::string text = heading(estimate);
  text += fmt::format("\n{:<{}} {:<8}{:>9}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "[m]", width, "use", "dX",
                      "dY", "dZ", "horiz.", "3D", "left out");
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const PairResidual& r = estimate.residuals[i];
    text += tableRow(pairs[i].name, width, useText(pairs[i].use),
                     {r.residual.x(), r.residual.y(), r.residual.z(), r.residual.head<2>().norm(),
                      r.residual.norm(), r.left_out.norm()},
                     r.outlier ? "outlier" : "");
  }
  for (const auto& [label, errors] : sums) {
    if (errors->count == 0) continue;
    text += tableRow(label, width, errors == &estimate.check ? "check" : "control",
                     {errors->rms.x(), errors->rms.y(), errors->rms.z(), errors->horizontal(),
                      errors->spatial(), std::nan("")},
                     fmt::format("{} pairs", errors->count));
  }
  return text;
}

}  // namespace agricolmap::control_points
