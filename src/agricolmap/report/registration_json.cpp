#include "agricolmap/report/registration_json.hpp"

#include <sys/resource.h>

#include <cmath>
#include <numbers>

#include "agricolmap/report/utf8.hpp"

namespace agricolmap {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

/// Null stands for numbers that JSON lacks.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

template <typename Derived>
Json vectorJson(const Eigen::MatrixBase<Derived>& vector) {
  Json json = Json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) json.push_back(number(vector(i)));
  return json;
}

/// Row-major, nested.
template <typename Derived>
Json matrixJson(const Eigen::MatrixBase<Derived>& matrix) {
  Json json = Json::array();
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) json.push_back(vectorJson(matrix.row(r)));
  return json;
}

Json stringsJson(const std::vector<std::string>& strings) {
  Json json = Json::array();
  for (const std::string& text : strings) json.push_back(validUtf8(text));
  return json;
}

Json cloudJson(const CloudReport& cloud, const Levelling& levelling, const GridMap& map) {
  Json json;
  json["path"] = validUtf8(cloud.path);
  json["points"] = cloud.points;
  json["dropped_points"] = cloud.dropped_points;
  json["has_colour"] = cloud.has_colour;
  json["origin_m"] = vectorJson(cloud.origin);
  json["box_min_m"] = vectorJson(cloud.box_min);
  json["box_max_m"] = vectorJson(cloud.box_max);
  json["ground"] = {{"tilt_deg", number(levelling.tilt * kDegPerRad)},
                    {"roughness_m", number(levelling.roughness)},
                    {"cells", levelling.cells}};
  json["map"] = {{"cell_m", number(map.frame.cell)},
                 {"rows", map.frame.rows},
                 {"cols", map.frame.cols},
                 {"filled_cells", map.filled},
                 {"points", map.points}};
  return json;
}

Json transformJson(const Registration& registration, const RegistrationReportInfo& info) {
  if (!registration.has_transform) return nullptr;
  Json json;
  json["matrix"] = matrixJson(registration.fixed_from_moving.matrix());
  json["local"] = {{"matrix", matrixJson(registration.local_fixed_from_moving.matrix())},
                   {"fixed_origin_m", vectorJson(info.fixed.origin)},
                   {"moving_origin_m", vectorJson(info.moving.origin)}};
  const HorizontalParts& parts = registration.parts;
  const Eigen::Vector2d& tilt = registration.tilt;
  json["parts"] = {{"yaw_deg", number(parts.yaw * kDegPerRad)},
                   {"tilt_x_deg", number(tilt.x() * kDegPerRad)},
                   {"tilt_y_deg", number(tilt.y() * kDegPerRad)},
                   {"scale_x", number(parts.scale_x)},
                   {"scale_y", number(parts.scale_y)},
                   {"scale_z", number(registration.vertical_scale)},
                   {"shear", number(parts.shear)},
                   {"shift_m", vectorJson(registration.shift)},
                   {"centre_m", vectorJson(registration.centre)}};
  return json;
}

/// Root mean square distance of the matches behind the pose from where the pose puts them [m].
double matchResidual(const Registration& registration) {
  double best = std::numeric_limits<double>::quiet_NaN();
  for (const Placement& placement : registration.association.placements) {
    if (placement.matches.empty()) continue;
    double sum = 0.0;
    for (const Match& match : placement.matches) {
      sum += (registration.pose * match.moving - match.fixed).squaredNorm();
    }
    const double rms = std::sqrt(sum / static_cast<double>(placement.matches.size()));
    if (!(rms >= best)) best = rms;
  }
  return best;
}

/// Root mean square offset of the agreeing blocks [m].
double blockResidual(const Evidence& evidence) {
  double sum = 0.0;
  for (const BlockEvidence& block : evidence.blocks) {
    if (block.agrees) sum += block.offset.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(evidence.agreeing));
}

const char* toString(VerticalStatus status) {
  switch (status) {
    case VerticalStatus::kOk:
      return "ok";
    case VerticalStatus::kTooFewCells:
      return "too_few_cells";
    case VerticalStatus::kTooSteep:
      return "too_steep";
  }
  return "unknown";
}

Json residualsJson(const Registration& registration) {
  if (!registration.has_transform) return nullptr;
  Json json;
  json["correlation"] = number(registration.correlation);
  json["signal"] = number(std::sqrt(2.0 - 2.0 * registration.correlation));
  json["overlap"] = number(registration.overlap);
  json["match_rms_m"] = number(matchResidual(registration));
  json["block_rms_m"] = number(blockResidual(registration.evidence));
  const VerticalResult& vertical = registration.vertical;
  json["vertical"] = {{"status", toString(vertical.status)},
                      {"residual_m", number(vertical.residual)},
                      {"cells", vertical.cells},
                      {"canopy_gain", number(vertical.canopy_gain)}};
  return json;
}

Json evidenceJson(const Evidence& evidence) {
  Json json;
  json["significance"] = number(evidence.significance);
  json["uniqueness"] = number(evidence.uniqueness);
  json["agreement"] = number(evidence.agreement());
  json["agreeing_blocks"] = evidence.agreeing;
  Json blocks = Json::array();
  for (const BlockEvidence& block : evidence.blocks) {
    blocks.push_back({{"place_m", vectorJson(block.place)},
                      {"offset_m", vectorJson(block.offset)},
                      {"agrees", block.agrees}});
  }
  json["blocks"] = std::move(blocks);
  return json;
}

Json numbersJson(const std::vector<std::pair<std::string, double>>& numbers,
                 const std::string& suffix) {
  Json json = Json::object();
  for (const auto& [name, value] : numbers) {
    // Counts as whole numbers: "6012", not "6012.0".
    const bool whole = suffix.empty() && std::abs(value) < 1e15 && value == std::floor(value);
    json[validUtf8(name) + suffix] = whole ? Json(static_cast<std::int64_t>(value)) : number(value);
  }
  return json;
}

}  // namespace

CloudReport cloudReport(const Cloud& cloud, std::string path) {
  CloudReport report;
  report.path = std::move(path);
  report.points = cloud.size();
  report.dropped_points = cloud.dropped_points;
  report.has_colour = cloud.hasColour();
  report.origin = cloud.origin;
  if (!cloud.empty()) {
    const Box3 box = boundingBox(cloud);
    report.box_min = cloud.origin + box.min.cast<double>();
    report.box_max = cloud.origin + box.max.cast<double>();
  }
  return report;
}

nlohmann::ordered_json registrationJson(const Registration& registration,
                                        const RegistrationReportInfo& info) {
  Json json;
  json["format"] = "agricolmap-registration";
  json["format_version"] = 1;
  json["status"] = toString(registration.verdict.status);
  json["reasons"] = stringsJson(registration.verdict.reasons);
  json["transform"] = transformJson(registration, info);
  json["guess"] = {{"matrix", matrixJson(info.guess.matrix())},
                   {"source", validUtf8(info.guess_source)}};
  json["residuals"] = residualsJson(registration);
  json["evidence"] = evidenceJson(registration.evidence);
  json["counts"] = numbersJson(registration.counts, "");
  json["fixed"] = cloudJson(info.fixed, registration.frames.fixed, registration.fixed_map);
  json["moving"] = cloudJson(info.moving, registration.frames.moving, registration.moving_map);
  json["times"] = {{"total_s", number(info.total_time)},
                   {"stages", numbersJson(info.stage_times, "_s")}};
  json["peak_memory_bytes"] = info.peak_memory;
  json["threads"] = info.threads;
  json["pictures"] = stringsJson(info.pictures);
  json["version"] = validUtf8(info.version);
  json["seed"] = info.seed;
  json["command_line"] = stringsJson(info.command_line);
  json["options"] = info.options;
  return json;
}

std::size_t peakMemoryBytes() {
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) != 0) return 0;
#ifdef __APPLE__
  constexpr std::size_t kUnit = 1;
#else
  constexpr std::size_t kUnit = 1024;
#endif
  return static_cast<std::size_t>(usage.ru_maxrss) * kUnit;
}

}  // namespace agricolmap
