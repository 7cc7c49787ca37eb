// agricolmap register FIXED MOVING -o DIR
#include <fmt/format.h>

#include <iostream>
#include <memory>
#include <numbers>

#include "agricolmap/config/json.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/report/json/registration_json.hpp"
#include "agricolmap/report/pictures/pictures.hpp"
#include "common.hpp"
#include "option_flags.hpp"

namespace agricolmap {
namespace {

struct RegisterArguments {
  std::string fixed;
  std::string moving;
  std::string output;
  std::string prior;
  std::string config;
  std::string preset = "default";
  std::string prior_sigma;
  bool scale_unknown = false;
  bool dump_config = false;
  bool keep_rejected = false;
  bool no_pictures = false;
  OptionFlags flags;
};

/// `T_M,HEADING_DEG,SCALE_PERCENT` or `none`, each value within its option's limits.
void applyPriorSigma(const std::string& text, PriorUncertainty& prior, const OptionTable& table) {
  if (text == "none") {
    const bool scale_unknown = prior.scale_unknown;
    prior = PriorUncertainty::none();
    prior.scale_unknown = scale_unknown;
    return;
  }
  std::vector<std::string> parts = CLI::detail::split(text, ',');
  for (std::string& part : parts) CLI::detail::trim(part);
  double scale = 0.0;
  if (parts.size() != 3 || !CLI::detail::lexical_cast(parts[2], scale)) {
    throw UsageError(fmt::format(
        "--prior-sigma {}: is neither T_M,HEADING_DEG,SCALE_PERCENT (such as 5,11.5,30) nor 'none'",
        text));
  }
  const auto set = [&](const char* key, const std::string& value) {
    try {
      config::parseOption(*table.find(key), value)();
    } catch (const UsageError& error) {
      throw UsageError(fmt::format("--prior-sigma {}: {}", text, error.what()));
    }
  };
  set("prior.translation", parts[0]);
  set("prior.heading_deg", parts[1]);
  set("prior.scale", fmt::format("{:.17g}", scale / 100.0));
}

/// Defaults, then the preset, then the configuration file, then flags.
pipeline::RegistrationOptions chosenOptions(const RegisterArguments& arguments,
                                            const Globals& globals) {
  pipeline::RegistrationOptions options = pipeline::preset(arguments.preset);
  options.flow.seed = globals.seed;
  options.affine.seed = globals.seed;
  OptionTable table = optionTable(options);
  if (!arguments.config.empty()) config::loadYaml(arguments.config, table);
  if (!arguments.prior_sigma.empty()) applyPriorSigma(arguments.prior_sigma, options.prior, table);
  if (arguments.scale_unknown) options.prior.scale_unknown = true;
  arguments.flags.apply(table);
  return options;
}

struct LoadedPair {
  Cloud fixed;
  Cloud moving;
};

LoadedPair load(const RegisterArguments& arguments) {
  LoadedPair pair;
  // Two files, two cores: the disk cache feeds both.
  parallelFor(2, [&](std::size_t i) {
    (i == 0 ? pair.fixed : pair.moving) =
        io::readCloud(i == 0 ? arguments.fixed : arguments.moving);
  });
  return pair;
}

void printSummary(const pipeline::Registration& result, const std::string& directory) {
  fmt::print("{}\n", toString(result.verdict.status));
  for (const std::string& reason : result.verdict.reasons) fmt::print("  {}\n", reason);
  if (result.has_transform) {
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    fmt::print(
        "relative to the initial guess: shift {:.3f} {:.3f} {:.3f} m, heading {:.3f} deg, scales "
        "{:.4f} {:.4f}\n",
        result.shift.x(), result.shift.y(), result.shift.z(), result.parts.yaw * kDegrees,
        result.parts.scale_x, result.parts.scale_y);
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
  info.seed = static_cast<std::uint64_t>(globals.seed);
  info.threads = globals.threads;
  info.command_line = commandText(globals.command_line);
  info.preset = arguments.preset;
  info.options = config::toJson(table);
  return info;
}

/// Fills `output` with everything but the report.
std::vector<std::string> writeResults(const RegisterArguments& arguments,
                                      const pipeline::RegistrationOptions& options,
                                      const LoadedPair& pair, const pipeline::Registration& result,
                                      const io::StagedOutput& output, StageTimes& times) {
  const bool keep = result.has_transform && (result.verdict.status == verdict::Status::kAccepted ||
                                             arguments.keep_rejected);
  if (keep) {
    times.run("write", [&] {
      io::writeMatrix(output.path("transform.txt"), result.fixed_from_moving);
      io::writePly(output.path("aligned.ply"), pair.moving, result.fixed_from_moving);
    });
  }
  if (arguments.no_pictures) return {};
  return times.run("pictures", [&] {
    return report::writePictures(output.folder(), result,
                                 {arguments.fixed, arguments.moving, options.evidence});
  });
}

ExitCode runRegister(const RegisterArguments& arguments, const Globals& globals) {
  pipeline::RegistrationOptions options = chosenOptions(arguments, globals);
  const OptionTable table = optionTable(options);
  if (arguments.dump_config) {
    std::cout << config::dumpYaml(table);
    return ExitCode::kOk;
  }
  if (arguments.fixed.empty() || arguments.moving.empty() || arguments.output.empty()) {
    throw UsageError("register needs FIXED, MOVING and -o DIR; see agricolmap register --help");
  }
  // First of all, so that the work does not end at a folder that cannot be written.
  io::StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  StageTimes times([&](std::string_view stage) { progress.step(stage); });
  report::RegistrationReportInfo info = reportInfo(arguments, globals, table);
  info.prior = initialGuess(arguments.fixed, arguments.moving, arguments.prior, info.prior_source);
  const LoadedPair pair = times.run("read", [&] { return load(arguments); });
  printWarnings(pair.fixed.warnings);
  printWarnings(pair.moving.warnings);
  const pipeline::Registration result =
      pipeline::registerClouds(pair.fixed, pair.moving, info.prior, options, times);
  info.pictures = writeResults(arguments, options, pair, result, output, times);
  report::writeRegistrationJson(output.path("registration.json"), pair.fixed, pair.moving, result,
                                times, info);
  throwIfInterrupted();
  std::vector<std::string> stale = report::pictureNames();
  stale.insert(stale.end(), {"transform.txt", "aligned.ply"});
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
  command->add_option("FIXED", arguments->fixed, "The wide map: PLY or PCD");
  command->add_option("MOVING", arguments->moving, "The map to be moved: PLY or PCD");
  command->add_option("-o,--output", arguments->output, "Folder for the results");
  command->add_option("--prior", arguments->prior,
                      "Initial guess: 4x4 text, row-major, moving -> fixed file coordinates. "
                      "Default: offset.xyz beside each cloud, else coordinates as they stand");
  command->add_option(
      "--prior-sigma", arguments->prior_sigma,
      "How wrong the initial guess may be: T_M,HEADING_DEG,SCALE_PERCENT, or 'none' "
      "for no guess: any place and heading [5,11.5,30]");
  command->add_flag("--scale-unknown", arguments->scale_unknown,
                    "MOVING is in unknown units: find its overall scale, too, a factor from 0.1 to "
                    "10");
  command->add_option("--preset", arguments->preset, "default, paper or paper-literal [default]");
  command->add_option("--config", arguments->config, "YAML file with options");
  command->add_flag("--dump-config", arguments->dump_config,
                    "Print all options in force as YAML and stop");
  command->add_flag("--keep-rejected", arguments->keep_rejected,
                    "Write transform.txt and aligned.ply of a rejected registration, too");
  command->add_flag("--no-pictures", arguments->no_pictures, "Write no PNG pictures");
  pipeline::RegistrationOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options of the pipeline");
  return {command, [arguments, &globals] { return runRegister(*arguments, globals); }};
}

}  // namespace agricolmap
