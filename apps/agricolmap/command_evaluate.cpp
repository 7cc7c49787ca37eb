// agricolmap evaluate TRANSFORM MOVING --truth TRUTH
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "agricolmap/core/affine_fit.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/evaluate/metrics.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

struct EvaluateArguments {
  std::string transform;
  std::string moving;
  std::string truth;
  std::string truth_points;
  std::string aligned;
  std::string output;
};

evaluate::Truth readTruth(const EvaluateArguments& arguments, const Cloud& moving) {
  evaluate::Truth truth;
  if (!arguments.truth_points.empty()) {
    const Cloud points = io::readCloud(arguments.truth_points, {.colours = false});
    printWarnings(points.warnings);
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
  const Cloud moving = io::readCloud(arguments.moving, {.colours = false});
  printWarnings(moving.warnings);
  const evaluate::Truth truth = readTruth(arguments, moving);
  const evaluate::RegistrationErrors errors = evaluate::evaluateTransform(estimate, truth, moving);
  std::optional<evaluate::RegistrationErrors> of_points;
  if (!arguments.aligned.empty()) {
    const Cloud aligned = io::readCloud(arguments.aligned, {.colours = false});
    printWarnings(aligned.warnings);
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
  command->add_option("-o,--output", arguments->output, "JSON file for the errors");
  return {command, [arguments, &globals] { return runEvaluate(*arguments, globals); }};
}

}  // namespace agricolmap
