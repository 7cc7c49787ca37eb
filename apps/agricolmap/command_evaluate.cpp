// agricolmap evaluate TRANSFORM MOVING --truth TRUTH
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/report/json/registration_file.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

struct EvaluateArguments {
  std::string transform;
  std::string moving;
  std::string truth;
  std::string truth_points;
  std::string aligned;
  std::string crs;
  std::string output;
};

bool saysCrs(const std::string& cloud) { return !cloud.empty() && io::crsOf(cloud).crs; }

/// What the coordinates that TRANSFORM and the truth lead to mean: as the user says, as the
/// registration does that TRANSFORM is a result of, or as a cloud does that lies there. Nothing
/// where nobody does, or no cloud says what would differ from it.
io::FileCrs targetOf(const EvaluateArguments& arguments) {
  io::FileCrs target;
  if (!saysCrs(arguments.moving) && !saysCrs(arguments.truth_points) &&
      !saysCrs(arguments.aligned)) {
    if (arguments.crs.empty()) return target;
    throw UsageError(
        "--crs would do nothing: none of the clouds says its coordinate system; put a .prj beside "
        "the one that is in another");
  }
  if (!arguments.crs.empty()) {
    target = io::crsOf(arguments.moving, arguments.crs);
    target.name = arguments.crs;
  }
  const std::filesystem::path report =
      std::filesystem::path(arguments.transform).parent_path() / "registration.json";
  std::error_code ignored;
  if (!target.crs && std::filesystem::exists(report, ignored)) {
    target.name = report.string();
    if (Crs crs = report::readRegistration(report).crs; !crs.wkt.empty()) {
      target.crs = std::move(crs);
    }
  }
  for (const std::string& cloud : {arguments.truth_points, arguments.aligned}) {
    if (!target.crs && !cloud.empty()) target = io::crsOf(cloud);
  }
  if (target.crs && !io::isProjected(*target.crs)) {
    throw InputError(fmt::format(
        "{}: its coordinates are degrees ({}), and errors are measured in metres; name a projected "
        "system that TRANSFORM leads to with --crs",
        target.name, target.crs->name));
  }
  return target;
}

/// A cloud in the target's system, as register brings it there; as it stands where the cloud does
/// not say what it is in.
Cloud readInto(const io::FileCrs& target, const std::string& path) {
  const io::FileCrs own = io::crsOf(path);
  io::CommonFrame frame;
  frame.warnings = own.warnings;
  if (own.crs && target.crs) {
    frame = io::commonFrame({target.name, target.crs, {}}, own);
  } else if (own.crs && io::isInMetres(*own.crs)) {
    frame.crs = *own.crs;
  } else if (own.crs) {
    throw InputError(fmt::format(
        "{}: is in {}, which is no system of metres, and nobody says which one TRANSFORM leads to; "
        "name it with --crs",
        path, own.crs->name));
  }
  printWarnings(frame.warnings);
  Cloud cloud = io::readCloud(path, {false, frame.moving.get()});
  printWarnings(cloud.warnings);
  io::checkGroundScale(path, frame.crs, cloud.origin.head<2>());
  return cloud;
}

evaluate::Truth readTruth(const EvaluateArguments& arguments, const io::FileCrs& target,
                          const Cloud& moving) {
  evaluate::Truth truth;
  if (!arguments.truth_points.empty()) {
    const Cloud points = readInto(target, arguments.truth_points);
    if (points.size() != moving.size()) {
      throw InputError(
          fmt::format("{}: has {} points, {} has {}; the truth needs one per moving "
                      "point, in the same order",
                      arguments.truth_points, points.size(), arguments.moving, moving.size()));
    }
    truth.points.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) truth.points.push_back(points.filePoint(i));
    truth.best_affine = fitAffine(moving, truth.points);
  } else {
    truth.best_affine = io::readTransform(arguments.truth);
  }
  return truth;
}

nlohmann::ordered_json toJson(const evaluate::RegistrationErrors& errors) {
  return {{"success", errors.within({})},
          {"rms_m", errors.rms},
          {"rms_horizontal_m", errors.rms_horizontal},
          {"rms_vertical_m", errors.rms_vertical},
          {"rms_to_best_affine_m", errors.rms_to_best_affine},
          {"worst_m", errors.worst},
          {"e_t_m", errors.translation},
          {"e_r_rad", errors.rotation},
          {"e_s", errors.scale}};
}

ExitCode runEvaluate(const EvaluateArguments& arguments, const Globals& globals) {
  if (arguments.truth.empty() == arguments.truth_points.empty()) {
    throw UsageError("evaluate needs either --truth or --truth-points");
  }
  const Eigen::Affine3d estimate = io::readMatrix(arguments.transform);
  const io::FileCrs target = targetOf(arguments);
  const Cloud moving = readInto(target, arguments.moving);
  const evaluate::Truth truth = readTruth(arguments, target, moving);
  const evaluate::RegistrationErrors errors = evaluate::evaluateTransform(estimate, truth, moving);
  std::optional<evaluate::RegistrationErrors> of_points;
  if (!arguments.aligned.empty()) {
    const Cloud aligned = readInto(target, arguments.aligned);
    of_points = evaluate::evaluateAligned(aligned, truth, moving);
  }
  if (!arguments.output.empty()) {
    io::StagedFile output(arguments.output, globals.overwrite);
    nlohmann::ordered_json json = toJson(errors);
    if (of_points) {
      json["aligned"] = {{"rms_m", of_points->rms},
                         {"rms_horizontal_m", of_points->rms_horizontal},
                         {"rms_vertical_m", of_points->rms_vertical},
                         {"worst_m", of_points->worst}};
    }
    io::writeText(output.path(), json.dump(2) + "\n");
    output.commit();
  }
  if (globals.quiet) return ExitCode::kOk;
  fmt::print("RMS displacement   {:.4f} m ({:.4f} horizontal, {:.4f} vertical)\n", errors.rms,
             errors.rms_horizontal, errors.rms_vertical);
  fmt::print("to the best affine {:.4f} m horizontal\n", errors.rms_to_best_affine);
  fmt::print("largest            {:.4f} m\n", errors.worst);
  fmt::print("e_t, e_r, e_s      {:.4f} m, {:.3f} deg, {:.2f} %\n", errors.translation,
             degrees(errors.rotation), 100.0 * errors.scale);
  fmt::print("within limits      {} (RMS and e_t 0.05 m, e_r 0.1 rad, e_s 2.5 %)\n",
             errors.within({}) ? "yes" : "no");
  if (of_points) {
    fmt::print(
        "aligned cloud      {:.4f} m ({:.4f} horizontal, {:.4f} vertical), largest {:.4f} m\n",
        of_points->rms, of_points->rms_horizontal, of_points->rms_vertical, of_points->worst);
  }
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addEvaluateCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::App* command = app.add_subcommand("evaluate", "Compare a transformation with the truth");
  command
      ->add_option("TRANSFORM", arguments->transform, "4x4 text, moving -> fixed file coordinates")
      ->required();
  command->add_option("MOVING", arguments->moving, "The moving cloud")->required();
  command->add_option("--truth", arguments->truth,
                      "True transform: 4x4 text, or 12 + 2 numbers as published with the paper");
  command->add_option("--truth-points", arguments->truth_points,
                      "Cloud with the true place of every moving point, in fixed file coordinates");
  command->add_option("--aligned", arguments->aligned,
                      "aligned.ply of the registration: its points are scored as they lie, too");
  command->add_option(
      "--crs", arguments->crs,
      "Coordinate system that TRANSFORM and the truth lead to: EPSG:32632, WKT or a "
      "file with it. Default: what registration.json beside TRANSFORM says, else "
      "the clouds that lie there; clouds that say another are brought to it");
  command->add_option("-o,--output", arguments->output, "JSON file for the errors");
  return {command, [arguments, &globals] { return runEvaluate(*arguments, globals); }};
}

}  // namespace agricolmap
