// agricolmap control-points PAIRS.csv -o DIR: the true transformation from hand-picked pairs.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <optional>

#include "agricolmap/control_points/control_points_file.hpp"
#include "agricolmap/control_points/control_points_report.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

struct ControlPointsArguments {
  std::string pairs;
  std::string output;
  std::string model = "scales";
};

void writeResults(const io::StagedOutput& output,
                  std::span<const control_points::ControlPair> pairs,
                  const control_points::ControlEstimate& estimate,
                  const ControlPointsArguments& arguments) {
  io::writeMatrix(output.path("truth.txt"), estimate.fixed_from_moving,
                  fmt::format("from {} control pairs, model {}, moving file -> fixed file",
                              estimate.control.count, toString(estimate.model)));
  const auto json = control_points::controlPointsJson(pairs, estimate, arguments.pairs);
  io::writeText(output.path("control_points.json"),
                json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n');
  io::writeText(output.path("residuals.csv"), control_points::residualsCsv(pairs, estimate));
}

ExitCode runControlPoints(const ControlPointsArguments& arguments, const Globals& globals) {
  std::optional<io::StagedOutput> output;
  if (!arguments.output.empty()) output.emplace(arguments.output, globals.overwrite);
  const std::vector<control_points::ControlPair> pairs =
      control_points::readControlPairs(arguments.pairs);
  const control_points::ControlOptions options{.model = arguments.model == "affine"
                                                            ? control_points::ControlModel::kAffine
                                                            : control_points::ControlModel::kScales,
                                               .seed = globals.seed};
  const control_points::ControlEstimate estimate =
      control_points::estimateFromPairs(pairs, options, arguments.pairs);
  if (output) {
    writeResults(*output, pairs, estimate, arguments);
    output->commit();
  }
  for (const std::string& warning : estimate.warnings) spdlog::warn("{}", warning);
  if (globals.quiet) return ExitCode::kOk;
  fmt::print("{}", control_points::residualsTable(pairs, estimate));
  if (output) fmt::print("results in {}\n", arguments.output);
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addControlPointsCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<ControlPointsArguments>();
  CLI::App* command = app.add_subcommand(
      "control-points", "Find the true transformation from pairs of places picked by hand");
  command
      ->add_option("PAIRS", arguments->pairs,
                   "CSV: name, moving_x, moving_y, moving_z, fixed_x, fixed_y, fixed_z [m] and, if "
                   "wanted, use (control, check)")
      ->required();
  command->add_option("-o,--output", arguments->output,
                      "Folder for truth.txt, control_points.json and residuals.csv");
  command
      ->add_option("--model", arguments->model,
                   "scales: rotation, a scale along the moving file's x and y, shift; affine: any "
                   "affine [scales]")
      ->check(CLI::IsMember({"scales", "affine"}));
  return {command, [arguments, &globals] { return runControlPoints(*arguments, globals); }};
}

}  // namespace agricolmap
