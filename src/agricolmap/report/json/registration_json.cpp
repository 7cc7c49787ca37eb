#include "agricolmap/report/json/registration_json.hpp"

#include <sys/resource.h>
#include <tbb/global_control.h>

#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/report/counts.hpp"
#include "agricolmap/report/json/json_values.hpp"
#include "agricolmap/report/json/utf8.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::ordered_json;

/// Of a cloud's file, before its coordinates were brought into the system of the report.
Json fileCrsJson(const std::optional<Crs>& crs) {
  if (!crs) return nullptr;
  return {{"name", validUtf8(crs->name)},
          {"wkt", validUtf8(crs->wkt)},
          {"horizontal_unit_m", number(crs->horizontal_unit)},
          {"vertical_unit_m", number(crs->vertical_unit)}};
}

Json cloudJson(const PointStream& stream, const std::optional<Crs>& file_crs,
               const map::Levelling& levelling, const map::Footprint& footprint,
               const map::GridMap& map) {
  const CloudFacts& cloud = stream.facts();
  Json json;
  json["path"] = validUtf8(cloud.name);
  json["points"] = cloud.points;
  json["dropped_points"] = cloud.dropped_points;
  json["stray_points"] = footprint.left_out;
  json["has_colour"] = cloud.coloured;
  json["crs"] = cloud.crs.wkt.empty()
                    ? Json(nullptr)
                    : Json{{"name", validUtf8(cloud.crs.name)}, {"wkt", validUtf8(cloud.crs.wkt)}};
  json["file_crs"] = fileCrsJson(file_crs);
  json["origin_m"] = vectorJson(cloud.origin);
  const Box3 box = stream.box();
  json["box_min_m"] = vectorJson((cloud.origin + box.min.cast<double>()).eval());
  json["box_max_m"] = vectorJson((cloud.origin + box.max.cast<double>()).eval());
  json["ground"] = {{"tilt_deg", number(degrees(levelling.tilt))},
                    {"roughness_m", number(levelling.roughness)},
                    {"cells", levelling.cells},
                    {"under_canopy", levelling.under_canopy},
                    {"support", number(levelling.support)}};
  json["map"] = {{"cell_m", number(map.frame.cell)},
                 {"rows", map.frame.rows},
                 {"cols", map.frame.cols},
                 {"filled_cells", map.filled},
                 {"points", map.points}};
  return json;
}

Json transformJson(const CloudFacts& fixed, const Cloud& moving,
                   const pipeline::Registration& registration) {
  if (!registration.transform.has_value()) return nullptr;
  Json json;
  json["matrix"] = matrixJson(registration.transform->fixed_from_moving.matrix());
  json["local"] = {{"matrix", matrixJson(registration.transform->local_fixed_from_moving.matrix())},
                   {"fixed_origin_m", vectorJson(fixed.origin)},
                   {"moving_origin_m", vectorJson(moving.origin)}};
  const HorizontalParts& parts = registration.transform->parts;
  const Eigen::Vector2d& tilt = registration.transform->tilt;
  json["parts"] = {{"yaw_deg", number(degrees(parts.yaw))},
                   {"tilt_x_deg", number(degrees(tilt.x()))},
                   {"tilt_y_deg", number(degrees(tilt.y()))},
                   {"scale_x", number(parts.scale_x)},
                   {"scale_y", number(parts.scale_y)},
                   {"scale_z", number(registration.transform->vertical_scale)},
                   {"shear", number(parts.shear)},
                   {"shift_m", vectorJson(registration.transform->shift)},
                   {"centre_m", vectorJson(registration.transform->centre)}};
  return json;
}

/// Root mean square distance of the matches behind the pose from where the pose puts them [m]; NaN
/// where a search found it as a whole.
double matchResidual(const pipeline::Registration& registration) {
  const std::vector<Match>& matches = winnerOf(registration).matches;
  double sum = 0.0;
  for (const Match& match : matches) {
    sum += (registration.placed->pose * match.moving - match.fixed).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(matches.size()));
}

/// Root mean square offset of the agreeing blocks [m].
double blockResidual(const verdict::Evidence& evidence) {
  double sum = 0.0;
  for (const verdict::BlockEvidence& block : evidence.blocks) {
    if (block.agrees) sum += block.offset.squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(evidence.agreeing));
}

const char* toString(refine::VerticalStatus status) {
  switch (status) {
    case refine::VerticalStatus::kOk:
      return "ok";
    case refine::VerticalStatus::kTooFewCells:
      return "too_few_cells";
    case refine::VerticalStatus::kTooSteep:
      return "too_steep";
  }
  return "unknown";
}

Json residualsJson(const pipeline::Registration& registration) {
  if (!registration.transform.has_value()) return nullptr;
  Json json;
  json["correlation"] = number(registration.placed->correlation);
  json["signal"] = number(std::sqrt(2.0 - 2.0 * registration.placed->correlation));
  json["overlap"] = number(registration.placed->overlap);
  const double cell = registration.placed->refined_cell;
  json["refined_cell_m"] = cell > 0.0 ? Json(cell) : Json(nullptr);
  json["match_rms_m"] = number(matchResidual(registration));
  json["block_rms_m"] = number(blockResidual(registration.placed->evidence));
  const refine::VerticalResult& vertical = registration.placed->heights;
  json["vertical"] = {{"status", toString(vertical.status)},
                      {"residual_m", number(vertical.residual)},
                      {"cells", vertical.cells},
                      {"ground_share", number(vertical.ground_share)},
                      {"ground_seen", number(vertical.ground_seen)},
                      {"lift_m", number(vertical.lift)},
                      {"blur_m", number(vertical.blur)},
                      {"relief_m", number(vertical.measured_scale.relief)},
                      {"relief_correlation", number(vertical.measured_scale.correlation)},
                      {"canopy_m", number(vertical.canopy)},
                      {"canopy_gain", number(vertical.canopy_gain)}};
  return json;
}

Json partsJson(const verdict::PartsReport& parts) {
  Json json;
  json["rms_m"] = number(parts.rms);
  const Eigen::Rotation2Dd back(-parts.turn);
  json["along"] = vectorJson((back * parts.along).eval());
  Json displaced = Json::array();
  for (const verdict::DisplacedPart& part : parts.displaced) {
    displaced.push_back({{"begin_m", number(part.begin)},
                         {"end_m", number(part.end)},
                         {"offset_m", vectorJson((back * part.offset).eval())},
                         {"significance", number(part.significance)},
                         {"uniqueness", number(part.uniqueness)}});
  }
  json["displaced"] = std::move(displaced);
  return json;
}

Json evidenceJson(const verdict::Evidence& evidence) {
  Json json;
  json["significance"] = number(evidence.significance);
  json["decoys"] = evidence.decoys;
  json["uniqueness"] = number(evidence.uniqueness);
  json["agreement"] = number(evidence.agreement());
  json["agreeing_blocks"] = evidence.agreeing;
  Json blocks = Json::array();
  const Eigen::Rotation2Dd back(-evidence.parts.turn);
  for (const verdict::BlockEvidence& block : evidence.blocks) {
    blocks.push_back({{"place_m", vectorJson((back * block.place).eval())},
                      {"offset_m", vectorJson((back * block.offset).eval())},
                      {"agrees", block.agrees}});
  }
  json["blocks"] = std::move(blocks);
  json["parts"] = partsJson(evidence.parts);
  return json;
}

Json heightsJson(const pipeline::Registration& registration) {
  if (!registration.transform.has_value()) return nullptr;
  const verdict::HeightsVerdict& heights = registration.verdict.heights;
  Json json;
  json["status"] = toString(heights.status);
  json["limit"] = heights.limited() ? Json(toString(heights.limit)) : Json(nullptr);
  json["words"] = describe(heights);
  json["deviation_m"] = number(heights.deviation);
  json["bias_m"] = number(heights.bias);
  const refine::VerticalScale& scale = registration.placed->heights.measured_scale;
  json["vertical_scale"] = scale.measured() ? "measured" : "assumed";
  json["measured_scale"] = scale.measured() ? number(scale.value) : Json(nullptr);
  json["scale_deviation"] = scale.measured() ? number(scale.deviation) : Json(nullptr);
  return json;
}

/// Of (shift_x, shift_y, shift_z [m], yaw [rad], scale_x, scale_y [relative]).
Json uncertaintyJson(const CloudFacts& fixed, const pipeline::Registration& registration) {
  if (!registration.transform.has_value() || !registration.placed->uncertainty) return nullptr;
  const verdict::PoseUncertainty& uncertainty = *registration.placed->uncertainty;
  const double turn = registration.maps.frames.turn;
  const Eigen::Rotation2Dd back(-turn);
  const Eigen::Matrix<double, 6, 6> covariance = uncertainty.covarianceWithHeight(turn);
  // The levelled frame is turned into the file's by `back` and a tilt.
  const Eigen::Affine3d file_from_levelled = registration.maps.frames.levelled_from_fixed.inverse();
  const Eigen::Vector3d centre =
      file_from_levelled * Eigen::Vector3d(uncertainty.centre.x(), uncertainty.centre.y(),
                                           registration.placed->heights.offset);
  Json json;
  json["parameters"] = {"shift_x_m", "shift_y_m", "shift_z_m", "yaw_rad", "scale_x", "scale_y"};
  json["covariance"] = matrixJson(covariance);
  json["deviations"] = vectorJson(covariance.diagonal().cwiseSqrt());
  json["centre_m"] = vectorJson((fixed.origin + centre).eval());
  json["axis_x"] = vectorJson((back * uncertainty.axes.col(0)).eval());
  json["axis_y"] = vectorJson((back * uncertainty.axes.col(1)).eval());
  json["expected_rms_m"] = number(uncertainty.expected_rms);
  json["systematic_rms_m"] = number(uncertainty.systematic_rms);
  json["scatter_rms_m"] = number(uncertainty.scatter_rms);
  json["local_rms_m"] = number(uncertainty.local_rms);
  return json;
}

/// All that makes the deformation's function of place, as deform/deformation.hpp has it.
Json functionJson(const deform::FileDeformation& function) {
  const deform::Deformation& deformation = function.deformation();
  Json path = Json::array();
  for (const Eigen::Vector2d& corner : deformation.path().corners()) {
    path.push_back(vectorJson(corner));
  }
  Json slips = Json::array();
  for (const deform::Slip& slip : deformation.slips) {
    slips.push_back({{"along_m", number(slip.along)}, {"offset_m", vectorJson(slip.offset)}});
  }
  Json json;
  json["levelled_from_moving"] = matrixJson(function.levelledFromMoving().matrix());
  json["path_m"] = std::move(path);
  json["turn"] = matrixJson(deformation.turn());
  json["spans"] = deformation.basis().spans();
  json["spacing_m"] = number(deformation.basis().spacing());
  json["coefficients_m"] = matrixJson(deformation.coefficients);
  json["slips"] = std::move(slips);
  json["fixed_from_displacement"] = matrixJson(function.fixedFromDisplacement());
  return json;
}

/// How the strip is bent beside the transform, at the nodes of its spline.
Json deformationJson(const Cloud& moving, const pipeline::Registration& registration) {
  if (!registration.transform.has_value() || !registration.placed->followed) return nullptr;
  const deform::Bend& bend = registration.placed->followed->bend;
  const deform::Deformation& deformation = bend.deformation;
  const pipeline::Displacement displacement(registration, moving);
  Json json;
  json["length_m"] = number(deformation.path().length());
  json["gain"] = number(bend.gain);
  json["evidence"] = number(bend.evidence);
  json["rms_m"] = number(bend.rms);
  json["most_m"] = number(bend.most);
  Json nodes = Json::array();
  for (int i = 1; i + 1 < deformation.basis().size(); ++i) {
    const double along = deformation.basis().place(i);
    const Eigen::Vector3d point = displacement.pathPoint(along);
    nodes.push_back({{"along_m", number(along)},
                     {"place_m", vectorJson(displacement.place(point))},
                     {"displacement_m", vectorJson(displacement.at(point))},
                     {"deviation_m",
                      vectorJson(displacement.covarianceAt(point).diagonal().cwiseSqrt().eval())}});
  }
  json["nodes"] = std::move(nodes);
  Json slips = Json::array();
  for (const deform::Slip& slip : deformation.slips) {
    const Eigen::Vector3d offset(slip.offset.x(), slip.offset.y(), 0.0);
    slips.push_back(
        {{"along_m", number(slip.along)},
         {"place_m", vectorJson(displacement.place(displacement.pathPoint(slip.along)))},
         {"offset_m", vectorJson(displacement.inFile(offset))},
         {"deviation_m", number(slip.deviation)},
         {"place_deviation_m", number(slip.place_deviation)}});
  }
  json["slips"] = std::move(slips);
  json["function"] = functionJson(displacement.function());
  return json;
}

Json alternativesJson(const pipeline::Registration& registration) {
  Json json = Json::array();
  for (const pipeline::Alternative& other : registration.alternatives) {
    json.push_back(
        {{"matrix", matrixJson(other.fixed_from_moving.matrix())},
         {"significance", number(other.significance)},
         {"relative", number(other.significance / registration.placed->evidence.significance)}});
  }
  return json;
}

Json countsJson(const pipeline::Registration& registration) {
  Json json = Json::object();
  for (const auto& [name, value] : countsOf(registration)) {
    // Counts as whole numbers: "6012", not "6012.0".
    const bool whole = std::abs(value) < 1e15 && value == std::floor(value);
    json[name] = whole ? Json(static_cast<std::int64_t>(value)) : number(value);
  }
  return json;
}

Json timesJson(const Monitor& monitor) {
  Json stages = Json::object();
  for (const StageTime& time : monitor.times()) {
    stages[std::string(nameOf(time.stage)) + "_s"] = number(time.seconds);
  }
  return {{"total_s", number(monitor.seconds())}, {"stages", stages}};
}

std::size_t threadsInForce(int asked) {
  if (asked > 0) return static_cast<std::size_t>(asked);
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

}  // namespace

std::vector<std::string> warningsOf(const PointStream& fixed, const Cloud& moving,
                                    const Monitor& monitor) {
  std::vector<std::string> all = fixed.facts().warnings;
  all.insert(all.end(), moving.warnings.begin(), moving.warnings.end());
  all.insert(all.end(), monitor.warnings().begin(), monitor.warnings().end());
  return all;
}

nlohmann::ordered_json registrationJson(const PointStream& fixed, const Cloud& moving,
                                        const pipeline::Registration& registration,
                                        const Monitor& monitor,
                                        const RegistrationReportInfo& info) {
  Json json;
  json["format"] = "agricolmap-registration";
  json["format_version"] = 1;
  json["status"] = toString(registration.verdict.status);
  json["reasons"] = stringsJson(registration.verdict.reasons);
  json["remedies"] = stringsJson(registration.verdict.remedies);
  json["warnings"] = stringsJson(warningsOf(fixed, moving, monitor));
  json["probability"] = number(registration.verdict.plane_probability);
  json["plane_probability"] = number(registration.verdict.plane_probability);
  json["place_probability"] = number(registration.verdict.place_probability);
  json["heights"] = heightsJson(registration);
  json["transform"] = transformJson(fixed.facts(), moving, registration);
  json["uncertainty"] = uncertaintyJson(fixed.facts(), registration);
  json["deformation"] = deformationJson(moving, registration);
  json["alternatives"] = alternativesJson(registration);
  json["prior"] = {{"matrix", matrixJson(info.prior.matrix())},
                   {"source", validUtf8(info.prior_source)}};
  json["residuals"] = residualsJson(registration);
  json["evidence"] =
      evidenceJson(registration.placed ? registration.placed->evidence : verdict::Evidence{});
  json["counts"] = countsJson(registration);
  const pipeline::PairMaps& maps = registration.maps;
  json["fixed"] = cloudJson(fixed, info.fixed_file_crs, maps.frames.fixed,
                            maps.frames.fixed_footprint, maps.fixed);
  json["moving"] = cloudJson(CloudStream(moving), info.moving_file_crs, maps.frames.moving,
                             maps.frames.moving_footprint, maps.moving);
  json["times"] = timesJson(monitor);
  json["peak_memory_bytes"] = peakMemoryBytes();
  json["threads"] = threadsInForce(info.threads);
  json["pictures"] = stringsJson(info.pictures);
  json["version"] = validUtf8(info.version);
  json["seed"] = info.seed;
  json["command_line"] = validUtf8(info.command_line);
  json["preset"] = validUtf8(info.preset);
  json["options"] = info.options;
  return json;
}

void writeRegistrationJson(const io::OutputPath& path, const PointStream& fixed,
                           const Cloud& moving, const pipeline::Registration& registration,
                           const Monitor& monitor, const RegistrationReportInfo& info) {
  io::writeText(path, registrationJson(fixed, moving, registration, monitor, info).dump(2) + "\n");
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

}  // namespace agricolmap::report
