// agricolmap register FIXED MOVING -o DIR
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "agricolmap/config/json.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/path_file.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/report/json/registration_json.hpp"
#include "agricolmap/report/pictures/pictures.hpp"
#include "common.hpp"
#include "pair_files.hpp"
#include "register_options.hpp"

namespace agricolmap {
namespace {

struct RegisterArguments {
  PairFiles files;
  std::string output;
  std::string prior;
  std::string path;
  bool dump_config = false;
  bool keep_rejected = false;
  bool no_pictures = false;
  RegisterOptions options;
};

void printSummary(const pipeline::Registration& result, const std::string& directory) {
  fmt::print("{}\n", headline(result.verdict));
  for (const std::string& reason : result.verdict.reasons) fmt::print("  {}\n", reason);
  if (!result.verdict.remedies.empty()) {
    fmt::print(
        "what may help (the guess: --prior; how good it is: --prior-sigma, --scale-unknown)\n");
    for (const std::string& remedy : result.verdict.remedies) fmt::print("  {}\n", remedy);
  }
  if (result.transform) {
    const pipeline::Transform& transform = *result.transform;
    fmt::print(
        "relative to the initial guess: shift {:.3f} {:.3f} {:.3f} m, heading {:.3f} deg, scales "
        "{:.4f} {:.4f}\n",
        transform.shift.x(), transform.shift.y(), transform.shift.z(), degrees(transform.parts.yaw),
        transform.parts.scale_x, transform.parts.scale_y);
  }
  fmt::print("results in {}\n", directory);
}

/// The command line as one line of text, quoted where a shell would need it.
std::string commandText(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n'\"\\$`*?&|;<>()[]{}#~!") == std::string::npos;
    if (plain) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

report::RegistrationReportInfo reportInfo(const RegisterArguments& arguments,
                                          const Globals& globals, const OptionTable& table) {
  report::RegistrationReportInfo info;
  info.version = AGRICOLMAP_VERSION;
  info.threads = globals.threads;
  info.command_line = commandText(globals.command_line);
  info.preset = arguments.options.preset();
  info.options = config::toJson(table);
  return info;
}

/// Where the registration puts points of the moving file.
io::PointMove moveOf(const pipeline::Registration& result, const Cloud& moving) {
  const Eigen::Affine3d& fixed_from_moving = result.transform->fixed_from_moving;
  if (!result.bent()) return fixed_from_moving;
  return {fixed_from_moving, [function = pipeline::Displacement(result, moving).function()](
                                 const Eigen::Vector3d& point) { return function.at(point); }};
}

/// Fills `output` with everything but the report.
std::vector<std::string> writeResults(const RegisterArguments& arguments,
                                      const pipeline::RegistrationOptions& options,
                                      const LoadedPair& pair, const pipeline::Registration& result,
                                      const io::StagedOutput& output, Monitor& monitor) {
  const bool keep = result.transform && (result.verdict.status == verdict::Status::kAccepted ||
                                         arguments.keep_rejected);
  if (keep) {
    monitor.run(Stage::kWrite, [&] {
      const Eigen::Affine3d& fixed_from_moving = result.transform->fixed_from_moving;
      io::writeMatrix(output.path("transform.txt"), fixed_from_moving, transformComment(pair));
      const auto warnings =
          writeAligned(arguments.files, pair, moveOf(result, pair.moving), output);
      printWarnings(warnings);
      for (const std::string& warning : warnings) monitor.warn(warning);
    });
  }
  if (arguments.no_pictures) return {};
  return monitor.run(Stage::kPictures, [&] {
    return report::writePictures(output.folder(), result,
                                 {arguments.files.fixed, arguments.files.moving, options.evidence});
  });
}

ExitCode runRegister(const RegisterArguments& arguments, const Globals& globals) {
  pipeline::RegistrationOptions options = arguments.options.chosen(globals);
  const OptionTable table = optionTable(options);
  if (arguments.dump_config) {
    std::cout << config::dumpYaml(table);
    return ExitCode::kOk;
  }
  if (arguments.files.fixed.empty() || arguments.files.moving.empty() || arguments.output.empty()) {
    throw UsageError("register needs FIXED, MOVING and -o DIR; see agricolmap register --help");
  }
  arguments.files.check();
  requirePictures(arguments.no_pictures);
  // First of all, so that the work does not end at a folder that cannot be written.
  io::StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  Monitor monitor(globals.stop, [&](Stage stage) { progress.step(nameOf(stage)); });
  report::RegistrationReportInfo info = reportInfo(arguments, globals, table);
  info.seed = static_cast<std::uint64_t>(options.seed);
  info.prior =
      initialGuess(io::mapFilesOf(arguments.files.fixed).main,
                   io::mapFilesOf(arguments.files.moving).main, arguments.prior, info.prior_source);
  const LoadedPair pair = monitor.run(Stage::kRead, [&] {
    return loadPair(arguments.files,
                    [&](std::size_t seen, std::size_t of) { progress.points(seen, of); });
  });
  info.fixed_file_crs = pair.frame.fixed_file;
  info.moving_file_crs = pair.frame.moving_file;
  for (const std::string& warning : pair.frame.warnings) monitor.warn(warning);
  printWarnings(pair.fixed->facts().warnings);
  printWarnings(pair.moving.warnings);
  const std::vector<Eigen::Vector3d> path =
      arguments.path.empty() ? std::vector<Eigen::Vector3d>{} : io::readPath(arguments.path);
  const pipeline::Registration result =
      pipeline::registerClouds(*pair.fixed, pair.moving, info.prior, options, monitor, {}, path);
  printWarnings(monitor.warnings());
  info.pictures = writeResults(arguments, options, pair, result, output, monitor);
  report::writeRegistrationJson(output.path("registration.json"), *pair.fixed, pair.moving, result,
                                monitor, info);
  throwIfInterrupted();
  std::vector<std::string> stale = report::pictureNames();
  stale.emplace_back("transform.txt");
  for (const std::string& name : alignedNames()) stale.push_back(name);
  output.commit(stale);
  if (!globals.quiet) printSummary(result, arguments.output);
  switch (result.verdict.status) {
    case verdict::Status::kAccepted:
      return ExitCode::kOk;
    case verdict::Status::kAmbiguous:
      return ExitCode::kAmbiguous;
    case verdict::Status::kRejected:
      break;
  }
  return ExitCode::kRejected;
}

}  // namespace

CommandSlot addRegisterCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* command = app.add_subcommand(
      "register", "Find the transformation that lays MOVING (UGV) into FIXED (UAV)");
  arguments->files.addTo(*command);
  command->add_option("-o,--output", arguments->output, "Folder for the results");
  command->add_option("--prior", arguments->prior,
                      "Initial guess: 4x4 text, row-major, moving -> fixed file coordinates. "
                      "Default: offset.xyz beside each cloud, else coordinates as they stand");
  command->add_option("--path", arguments->path,
                      "Where the robot drove, in MOVING's coordinates: a line for each place, "
                      "'x y', 'x y z', 't x y z' or TUM's 't x y z qx qy qz qw', or columns named "
                      "x and y. Default: as the strip's shape tells");
  command->add_flag("--dump-config", arguments->dump_config,
                    "Print all options in force as YAML and stop");
  command->add_flag("--keep-rejected", arguments->keep_rejected,
                    "Write transform.txt and the aligned cloud of a rejected registration, too");
  command->add_flag("--no-pictures", arguments->no_pictures, "Write no PNG pictures");
  arguments->options.addTo(*command);
  return {command, [arguments, &globals] { return runRegister(*arguments, globals); }};
}

}  // namespace agricolmap
