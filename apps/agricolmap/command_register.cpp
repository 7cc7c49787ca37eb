// agricolmap register FIXED MOVING -o DIR
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/run/register_run.hpp"
#include "common.hpp"
#include "register_options.hpp"

namespace agricolmap {
namespace {

struct RegisterArguments {
  run::PairFiles files;
  std::string output;
  std::string prior;
  std::string path;
  bool dump_config = false;
  bool keep_rejected = false;
  bool no_pictures = false;
  RegisterOptions options;
};

ExitCode exitCodeOf(verdict::Status status) {
  switch (status) {
    case verdict::Status::kAccepted:
      return ExitCode::kOk;
    case verdict::Status::kAmbiguous:
      return ExitCode::kAmbiguous;
    case verdict::Status::kRejected:
      break;
  }
  return ExitCode::kRejected;
}

/// FIXED and MOVING, and what is said of them.
void addFlags(run::PairFiles& files, CLI::App& command) {
  command.add_option("FIXED", files.fixed,
                     "The wide map: LAS, LAZ, PLY, PCD, lines of text, or ORTHO.tif,DSM.tif");
  command.add_option("MOVING", files.moving, "The map to be moved: the same");
  command.add_option("--fixed-crs", files.fixed_crs,
                     "Coordinate system of FIXED: EPSG:32632, WKT or a file with it. Default: what "
                     "the file or a .prj beside it says, else that of MOVING");
  command.add_option("--moving-crs", files.moving_crs,
                     "The same of MOVING; brought to that of FIXED");
  command.add_option(
      "--aligned-format", files.aligned,
      "Format of the aligned cloud: ply, pcd, las, laz, copc, or auto: las or laz as MOVING is, "
      "else ply [auto]");
}

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
  if (arguments.files.aligned != "auto") {
    run::formatNamed("--aligned-format", arguments.files.aligned);
  }
  requirePictures(arguments.no_pictures);
  // First of all, so that the work does not end at a folder that cannot be written.
  io::StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  Monitor monitor(globals.stop, [&](Stage stage) { progress.step(nameOf(stage)); });
  run::RegisterRun asked;
  asked.files = arguments.files;
  asked.prior = arguments.prior;
  asked.path = arguments.path;
  asked.keep_rejected = arguments.keep_rejected;
  asked.pictures = !arguments.no_pictures;
  asked.preset = arguments.options.preset();
  asked.options = options;
  asked.version = AGRICOLMAP_VERSION;
  asked.command_line = run::commandText(globals.command_line);
  asked.threads = globals.threads;
  const run::FixedSource fixed = [&](const io::MapFiles& files, const io::CommonFrame& frame) {
    return run::streamedFixed(files, frame, progress.ofPasses());
  };
  const pipeline::Registration result =
      run::registerInto(asked, fixed, output, monitor, printWarnings).registration;
  output.commit(run::staleResults());
  if (!globals.quiet) printSummary(result, arguments.output);
  return exitCodeOf(result.verdict.status);
}

}  // namespace

CommandSlot addRegisterCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* command = app.add_subcommand(
      "register", "Find the transformation that lays MOVING (UGV) into FIXED (UAV)");
  addFlags(arguments->files, *command);
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
  command->add_flag("--no-pictures", arguments->no_pictures,
                    "Write no PNG pictures, and reports of words and numbers only");
  arguments->options.addTo(*command);
  return {command, [arguments, &globals] { return runRegister(*arguments, globals); }};
}

}  // namespace agricolmap
