#include "agricolmap/report/json/registration_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::report {
namespace {

using Json = nlohmann::json;

constexpr int kVersion = 1;

/// Reads values by their place in the document, which messages name.
class Reader {
 public:
  Reader(const Json& json, std::string name, std::string place = "")
      : json_(json), name_(std::move(name)), place_(std::move(place)) {}

  template <typename... Args>
  [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
    throw InputError(fmt::format("{}: damaged: {}{}{}", name_, place_, place_.empty() ? "" : " ",
                                 fmt::format(format, std::forward<Args>(args)...)));
  }
  bool isNull() const { return json_.is_null(); }
  Reader at(const std::string& key) const {
    const std::string place = place_.empty() ? key : place_ + "." + key;
    if (!json_.is_object() || !json_.contains(key)) {
      throw InputError(fmt::format("{}: damaged: {} is missing", name_, place));
    }
    return {json_.at(key), name_, place};
  }
  bool has(const std::string& key) const { return json_.is_object() && json_.contains(key); }
  std::vector<Reader> items() const {
    if (!json_.is_array()) fail("is no list");
    std::vector<Reader> all;
    for (std::size_t i = 0; i < json_.size(); ++i) {
      all.emplace_back(json_[i], name_, fmt::format("{}[{}]", place_, i));
    }
    return all;
  }
  double number() const {
    if (!json_.is_number()) fail("is no number");
    return json_.get<double>();
  }
  std::string text() const {
    if (!json_.is_string()) fail("is no text");
    return json_.get<std::string>();
  }
  int integer() const {
    if (!json_.is_number_integer()) fail("is no whole number");
    return json_.get<int>();
  }
  template <int kSize>
  Eigen::Matrix<double, kSize, 1> vector() const {
    const auto all = items();
    if (all.size() != kSize) fail("has {} numbers, not {}", all.size(), kSize);
    Eigen::Matrix<double, kSize, 1> vector;
    for (int i = 0; i < kSize; ++i) vector[i] = all[static_cast<std::size_t>(i)].number();
    return vector;
  }
  template <int kRows, int kCols>
  Eigen::Matrix<double, kRows, kCols> matrix() const {
    const auto all = items();
    if (all.size() != kRows) fail("has {} rows, not {}", all.size(), kRows);
    Eigen::Matrix<double, kRows, kCols> matrix;
    for (int r = 0; r < kRows; ++r) {
      matrix.row(r) = all[static_cast<std::size_t>(r)].template vector<kCols>().transpose();
    }
    return matrix;
  }
  Eigen::Affine3d affine() const {
    const Eigen::Matrix4d whole = matrix<4, 4>();
    if (whole.row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) fail("does not end in 0 0 0 1");
    Eigen::Affine3d affine;
    affine.matrix() = whole;
    const double volume = affine.linear().determinant();
    if (!(volume > 1e-9 && volume < 1e9)) fail("is no way from one field to another");
    return affine;
  }

 private:
  const Json& json_;
  std::string name_;
  std::string place_;
};

deform::Path pathOf(const Reader& json) {
  std::vector<Eigen::Vector2d> corners;
  for (const Reader& corner : json.items()) corners.push_back(corner.vector<2>());
  try {
    return deform::Path(corners);
  } catch (const UsageError& error) {
    json.fail("is none: {}", error.what());
  }
}

deform::FileDeformation deformationOf(const Reader& json) {
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
  for (const Reader& slip : json.at("slips").items()) {
    deform::Slip& stored = deformation.slips.emplace_back();
    stored.along = slip.at("along_m").number();
    stored.offset = slip.at("offset_m").vector<2>();
  }
  return {std::move(deformation), json.at("levelled_from_moving").affine(),
          json.at("fixed_from_displacement").matrix<3, 3>()};
}

Crs crsOf(const Reader& json) {
  Crs crs;
  crs.name = json.at("name").text();
  crs.wkt = json.at("wkt").text();
  return crs;
}

StoredRegistration storedIn(const Reader& json, const std::string& name) {
  StoredRegistration stored;
  stored.status = json.at("status").text();
  for (const Reader& reason : json.at("reasons").items()) stored.reasons.push_back(reason.text());
  if (const Reader transform = json.at("transform"); !transform.isNull()) {
    stored.fixed_from_moving = transform.at("matrix").affine();
  }
  if (stored.accepted() && !stored.fixed_from_moving) json.at("transform").fail("is missing");
  if (const Reader deformation = json.at("deformation"); !deformation.isNull()) {
    if (!deformation.has("function")) {
      throw InputError(fmt::format(
          "{}: was written by a version that did not keep the deformation in full; register the "
          "pair again",
          name));
    }
    stored.deformation = deformationOf(deformation.at("function"));
  }
  const Reader moving = json.at("moving");
  stored.moving_origin = moving.at("origin_m").vector<3>();
  if (const Reader crs = moving.at("crs"); !crs.isNull()) stored.crs = crsOf(crs);
  if (stored.crs.wkt.empty() || !moving.has("file_crs")) return stored;
  if (const Reader crs = moving.at("file_crs"); !crs.isNull()) {
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
  const io::MappedFile file(path);
  const Json json = Json::parse(file.text(), nullptr, false);
  if (json.is_discarded()) {
    throw InputError(fmt::format("{}: damaged: is no JSON, or ends too early", name));
  }
  const Reader reader(json, name);
  if (!reader.has("format") || json["format"] != "agricolmap-registration") {
    throw InputError(fmt::format("{}: is no report of a registration", name));
  }
  if (const int version = reader.at("format_version").integer(); version != kVersion) {
    throw InputError(fmt::format(
        "{}: is of format version {}, and this program knows version {}; use the version of "
        "agricolmap that wrote it, or a newer one",
        name, version, kVersion));
  }
  return storedIn(reader, name);
}

}  // namespace agricolmap::report
