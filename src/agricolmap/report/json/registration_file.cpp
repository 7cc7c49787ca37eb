#include "agricolmap/report/json/registration_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/report/json/json_reader.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::json;

deform::Path pathOf(const JsonReader& json) {
  std::vector<Eigen::Vector2d> corners;
  for (const JsonReader& corner : json.items()) corners.push_back(corner.vector<2>());
  try {
    return deform::Path(corners);
  } catch (const UsageError& error) {
    json.fail("is none: {}", error.what());
  }
}

deform::FileDeformation deformationOf(const JsonReader& json) {
  const int spans = json.at("spans").integer();
  const double spacing = json.at("spacing_m").number();
  if (spans < 1 || !(spacing > 0.0)) json.fail("has no spans");
  const auto basis = deform::SplineBasis::ofSpans(spans, spacing);
  const auto coefficients = json.at("coefficients_m").items();
  if (coefficients.size() != static_cast<std::size_t>(basis.size())) {
    json.fail("has {} coefficients for {} spans", coefficients.size(), spans);
  }
  deform::Deformation deformation(pathOf(json.at("path_m")), json.at("turn").matrix<2, 2>(), basis);
  for (int i = 0; i < basis.size(); ++i) {
    deformation.coefficients.row(i) =
        coefficients[static_cast<std::size_t>(i)].vector<3>().transpose();
  }
  for (const JsonReader& slip : json.at("slips").items()) {
    deform::Slip& stored = deformation.slips.emplace_back();
    stored.along = slip.at("along_m").number();
    stored.offset = slip.at("offset_m").vector<2>();
  }
  return {std::move(deformation), json.at("levelled_from_moving").affine(),
          json.at("fixed_from_displacement").matrix<3, 3>()};
}

Crs crsOf(const JsonReader& json) {
  Crs crs;
  crs.name = json.at("name").text();
  crs.wkt = json.at("wkt").text();
  return crs;
}

StoredRegistration storedIn(const JsonReader& json, const std::string& name) {
  StoredRegistration stored;
  stored.status = json.at("status").text();
  for (const JsonReader& reason : json.at("reasons").items())
    stored.reasons.push_back(reason.text());
  if (const JsonReader transform = json.at("transform"); !transform.isNull()) {
    stored.fixed_from_moving = transform.at("matrix").affine();
  }
  if (stored.accepted() && !stored.fixed_from_moving) json.at("transform").fail("is missing");
  if (const JsonReader deformation = json.at("deformation"); !deformation.isNull()) {
    if (!deformation.has("function")) {
      throw InputError(fmt::format(
          "{}: was written by a version that did not keep the deformation in full; register the "
          "pair again",
          name));
    }
    stored.deformation = deformationOf(deformation.at("function"));
  }
  if (const JsonReader errors = json.at("uncertainty"); !errors.isNull()) {
    stored.plane_error = errors.at("expected_rms_m").numberOr(stored.plane_error);
  }
  if (const JsonReader heights = json.at("heights"); !heights.isNull()) {
    stored.height_error = heights.at("deviation_m").numberOr(stored.height_error);
    stored.heights_limited = heights.at("status").text() != "measured";
  }
  const JsonReader moving = json.at("moving");
  stored.moving_origin = moving.at("origin_m").vector<3>();
  if (const JsonReader crs = moving.at("crs"); !crs.isNull()) stored.crs = crsOf(crs);
  if (stored.crs.wkt.empty() || !moving.has("file_crs")) return stored;
  if (const JsonReader crs = moving.at("file_crs"); !crs.isNull()) {
    stored.moving_file_crs = crsOf(crs);
    stored.moving_file_crs->horizontal_unit = crs.at("horizontal_unit_m").number();
    stored.moving_file_crs->vertical_unit = crs.at("vertical_unit_m").number();
  }
  return stored;
}

}  // namespace

StoredRegistration readRegistration(const std::filesystem::path& run) {
  std::error_code ignored;
  const std::filesystem::path path =
      std::filesystem::is_directory(run, ignored) ? run / "registration.json" : run;
  if (!std::filesystem::exists(path, ignored)) {
    throw InputError(
        fmt::format("{}: there is no {}: name the folder that `register` wrote its results to",
                    run.string(), path == run ? "such file or folder" : "registration.json in it"));
  }
  const std::string name = path.string();
  const Json json = readDocument(
      path, {"agricolmap-registration", "report of a registration", "register the pair again"});
  const JsonReader reader(json, name);
  return storedIn(reader, name);
}

}  // namespace agricolmap::report
