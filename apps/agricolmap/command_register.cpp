// agricolmap register FIXED MOVING -o DIR
#include <fmt/format.h>

#include <iostream>
#include <memory>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/angles.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "common.hpp"
#include "pair_files.hpp"
#include "register_options.hpp"
#include "register_run.hpp"

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
  RegisterRun run;
  run.files = arguments.files;
  run.prior = arguments.prior;
  run.path = arguments.path;
  run.keep_rejected = arguments.keep_rejected;
  run.pictures = !arguments.no_pictures;
  run.preset = arguments.options.preset();
  run.options = options;
  run.command_line = commandText(globals.command_line);
  run.threads = globals.threads;
  const FixedSource fixed = [&](const io::MapFiles& files, const io::CommonFrame& frame) {
    return streamedFixed(files, frame, progress.ofPasses());
  };
  const pipeline::Registration result =
      registerInto(run, fixed, output, monitor, printWarnings).registration;
  output.commit(staleResults());
  if (!globals.quiet) printSummary(result, arguments.output);
  return exitCodeOf(result.verdict.status);
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
  command->add_flag("--no-pictures", arguments->no_pictures,
                    "Write no PNG pictures, and reports of words and numbers only");
  arguments->options.addTo(*command);
  return {command, [arguments, &globals] { return runRegister(*arguments, globals); }};
}

}  // namespace agricolmap
