// agricolmap simulate -o DIR: a pair of clouds with exact truth, of a simulated crop or of a real
// orthomosaic.
#include <fmt/format.h>

#include <memory>

#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/io/text/path_file.hpp"
#include "agricolmap/simulate/picture/pair_picture.hpp"
#include "agricolmap/simulate/simulate.hpp"
#include "common.hpp"
#include "option_flags.hpp"
#include "ortho_arguments.hpp"

namespace agricolmap {
namespace {

constexpr const char* kPicture = "pair.png";

struct SimulateArguments {
  std::string output;
  std::string config;
  bool dump_config = false;
  bool no_pictures = false;
  OptionFlags flags;
  OrthoArguments ortho;
};

/// The crop's preset, then the configuration file, then flags; the crop may come from either.
simulate::SimulationOptions chosenOptions(const SimulateArguments& arguments,
                                          const Globals& globals) {
  const auto fill = [&](simulate::SimulationOptions& options) {
    OptionTable table = optionTable(options);
    if (!arguments.config.empty()) config::loadYaml(arguments.config, table);
    if (globals.seed_given) options.seed = globals.seed;
    arguments.flags.apply(table);
  };
  simulate::SimulationOptions first;
  fill(first);
  simulate::SimulationOptions options = simulate::cropPreset(first.crop);
  fill(options);
  return options;
}

Cloud truthCloud(const simulate::SimulatedPair& pair) {
  Cloud cloud;
  cloud.name = "truth";
  cloud.origin = pair.uav.origin;
  cloud.xyz.reserve(pair.truth.size());
  for (const Eigen::Vector3d& p : pair.truth) {
    cloud.xyz.push_back((p - cloud.origin).cast<float>());
  }
  return cloud;
}

void writeClouds(const io::StagedOutput& output, const simulate::SimulatedPair& pair) {
  io::writePly(output.path("uav/point_cloud.ply"), pair.uav);
  io::writePly(output.path("ugv/point_cloud.ply"), pair.ugv);
  // The UAV's file is the world; the UGV's geotag is what the initial guess knows.
  io::writeOffset(output.path("uav/offset.xyz"), Eigen::Affine3d::Identity());
  io::writeOffset(output.path("ugv/offset.xyz"), pair.prior);
  io::writePath(output.path("ugv/path.txt"), pair.path, "x y z of the robot, UGV file");
  io::writeMatrix(output.path("prior.txt"), pair.prior, "initial guess, UGV file -> UAV file");
  io::writeMatrix(output.path("truth.txt"), pair.best_affine,
                  "best affine, UGV file -> UAV file; not exact where the strip drifts");
  io::writePly(output.path("truth_points.ply"), truthCloud(pair));
}

void writePicture(const io::StagedOutput& output, const simulate::SimulatedPair& pair,
                  const std::string& field, int seed) {
  simulate::PairPictureInfo info;
  info.title = fmt::format("Simulated pair: {}, seed {}", field, seed);
  if (!pair.overlaps) info.title += ", of different fields";
  info.same_field = pair.overlaps;
  simulate::writePairPicture(output.path(kPicture), pair.uav, pair.ugv, pair.best_affine, info);
}

ExitCode runSimulate(SimulateArguments& arguments, const Globals& globals) {
  simulate::SimulationOptions options = chosenOptions(arguments, globals);
  const bool from_ortho = arguments.ortho.given(arguments.flags);
  const OptionTable table = optionTable(options);
  if (arguments.dump_config) {
    fmt::print("{}", config::dumpYaml(table));
    return ExitCode::kOk;
  }
  if (arguments.output.empty()) throw UsageError("simulate needs -o DIR");
  requirePictures(arguments.no_pictures);
  io::StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  progress.step("simulate");
  const simulate::SimulatedPair pair =
      from_ortho ? arguments.ortho.simulate(options) : simulate::simulatePair(options);
  progress.step("write");
  writeClouds(output, pair);
  io::writeText(output.path("simulation.yaml"),
                (from_ortho ? arguments.ortho.provenance() : "") + config::dumpYaml(table));
  if (!arguments.no_pictures) {
    progress.step("picture");
    writePicture(output, pair,
                 from_ortho ? arguments.ortho.fileName() : config::optionText(*table.find("crop")),
                 options.seed);
  }
  output.commit({kPicture});
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
  command->add_flag("--no-pictures", arguments->no_pictures, "Write no PNG picture");
  arguments->ortho.addTo(*command);
  simulate::SimulationOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options of the simulator", {"seed"});
  return {command, [arguments, &globals] { return runSimulate(*arguments, globals); }};
}

}  // namespace agricolmap
