// agricolmap simulate -o DIR: a pair of clouds with exact truth, of a simulated crop or of a real
// orthomosaic.
#include <fmt/format.h>

#include <memory>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/io/cloud_writer.hpp"
#include "agricolmap/io/file_sink.hpp"
#include "agricolmap/io/matrix_file.hpp"
#include "agricolmap/io/offset_file.hpp"
#include "agricolmap/io/staged_output.hpp"
#include "agricolmap/simulate/simulate.hpp"
#include "common.hpp"
#include "option_flags.hpp"
#include "ortho_arguments.hpp"

namespace agricolmap {
namespace {

struct SimulateArguments {
  std::string output;
  std::string config;
  bool dump_config = false;
  OptionFlags flags;
  OrthoArguments ortho;
};

/// The crop's preset, then the configuration file, then flags; the crop may come from either.
SimulationOptions chosenOptions(const SimulateArguments& arguments, const Globals& globals) {
  const auto fill = [&](SimulationOptions& options) {
    OptionTable table = optionTable(options);
    if (!arguments.config.empty()) loadYaml(arguments.config, table);
    arguments.flags.apply(table);
  };
  SimulationOptions first;
  fill(first);
  SimulationOptions options = cropPreset(first.crop);
  options.seed = globals.seed;
  fill(options);
  return options;
}

Cloud truthCloud(const SimulatedPair& pair) {
  Cloud cloud;
  cloud.name = "truth";
  cloud.origin = pair.uav.origin;
  cloud.xyz.reserve(pair.truth.size());
  for (const Eigen::Vector3d& p : pair.truth) {
    cloud.xyz.push_back((p - cloud.origin).cast<float>());
  }
  return cloud;
}

ExitCode runSimulate(SimulateArguments& arguments, const Globals& globals) {
  SimulationOptions options = chosenOptions(arguments, globals);
  const bool from_ortho = arguments.ortho.given(arguments.flags);
  const OptionTable table = optionTable(options);
  if (arguments.dump_config) {
    fmt::print("{}", dumpYaml(table));
    return ExitCode::kOk;
  }
  if (arguments.output.empty()) throw UsageError("simulate needs -o DIR");
  StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  progress.step("simulate");
  const SimulatedPair pair = from_ortho ? arguments.ortho.simulate(options) : simulatePair(options);
  progress.step("write");
  writePly(output.path("uav/point_cloud.ply"), pair.uav);
  writePly(output.path("ugv/point_cloud.ply"), pair.ugv);
  // The UAV's file is the world; the UGV's geotag is what the initial guess knows.
  writeOffset(output.path("uav/offset.xyz"), Eigen::Affine3d::Identity());
  writeOffset(output.path("ugv/offset.xyz"), pair.prior);
  writeMatrix(output.path("prior.txt"), pair.prior, "initial guess, UGV file -> UAV file");
  writeMatrix(output.path("truth.txt"), pair.best_affine,
              "best affine, UGV file -> UAV file; not exact where the strip drifts");
  writePly(output.path("truth_points.ply"), truthCloud(pair));
  writeText(output.path("simulation.yaml"),
            (from_ortho ? arguments.ortho.provenance() : "") + dumpYaml(table));
  output.commit();
  if (!globals.quiet) {
    fmt::print("{}: UAV {} points, UGV {} points{}\n", arguments.output, pair.uav.size(),
               pair.ugv.size(), pair.overlaps ? "" : ", from different fields");
  }
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addSimulateCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* command = app.add_subcommand(
      "simulate",
      "Make a UAV/UGV pair of a crop field with exact truth, in the layout of the "
      "published data set: of a simulated crop, or cut from a real orthomosaic (--ortho)");
  command->add_option("-o,--output", arguments->output, "Folder for the pair");
  command->add_option("--config", arguments->config, "YAML file with options");
  command->add_flag("--dump-config", arguments->dump_config,
                    "Print all options in force as YAML and stop");
  arguments->ortho.addTo(*command);
  SimulationOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options of the simulator", {"seed"});
  return {command, [arguments, &globals] { return runSimulate(*arguments, globals); }};
}

}  // namespace agricolmap
