// What is written from the same tables and flags as the command line: docs/options.md, manual pages
// and completions.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "agricolmap/config/markdown.hpp"
#include "agricolmap/crop/facts.hpp"
#include "agricolmap/fuse/options.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/raster/raster_import.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/prescribe/lattice.hpp"
#include "agricolmap/simulate/ortho/ortho_file.hpp"
#include "agricolmap/simulate/simulation_options.hpp"
#include "common.hpp"
#include "shell_files.hpp"

namespace agricolmap {
namespace {

template <typename Options>
void printSection(const char* verb, const char* about) {
  Options defaults;
  fmt::print("\n## agricolmap {}\n\n{}\n\n{}", verb, about,
             config::toMarkdown(optionTable(defaults)));
}

ExitCode runDocument() {
  fmt::print(
      "# Options\n\n"
      "<!-- Written by `agricolmap document-options`; a test compares. -->\n\n"
      "Every option is a flag (`--grid.cell 0.02`, `--prior.heading-deg 3`; `-` stands for `_`) "
      "and, for\n"
      "`register`, `simulate` and `fuse`, a key of the YAML file given with `--config` (`grid:` "
      "and below "
      "it\n"
      "`cell: 0.02`). Flags win over the file, the file over the preset. `--dump-config` prints "
      "what is in\n"
      "force. `--help` shows the options for users, `--help-all` all. What would do nothing beside "
      "the others\n"
      "is refused: a flag always, a value in a file unless it is the default.\n");
  printSection<pipeline::RegistrationOptions>(
      "register",
      "Defaults are those of `--preset default`; `--preset paper` "
      "and `--preset paper-literal` have "
      "others.");
  printSection<simulate::SimulationOptions>(
      "simulate", "Defaults are those of the default crop; each `--crop` brings its own.");
  printSection<simulate::OrthoFileOptions>(
      "simulate --ortho",
      "How an orthomosaic is read; flags only, beside `--dsm`, `--dtm`, `--window` and "
      "`--row-heading`. Of the\noptions above, `field.width` and `field.height` limit the part of "
      "the mosaic that is taken,\n`field.random_row_heading` stands for a measured heading of the "
      "rows, and `field.relief`, `field.slope`,\n`field.clods` and `field.plant_size` are used "
      "where there is no surface model. The rest of `field.*` and\n`views.weeds_pulled`, "
      "`views.weeds_new`, `views.plants_lost`, `views.growth_spread`,\n`views.ripeness`, "
      "`views.ripening`, `views.soil_kept` and `views.soil_contrast` do nothing\nand are refused "
      "as "
      "flags. `uav.gsd` is at least the mosaic's.");
  printSection<io::ImportOptions>(
      "convert and import", "From an orthomosaic and a surface model to a cloud; flags only.");
  printSection<fuse::FuseOptions>("fuse", "One map of a drone's cloud and strips.");
  printSection<crop::FactsOptions>("facts", "What is looked for on a field; flags only.");
  printSection<prescribe::SquareOptions>("prescribe",
                                         "The squares that get one rate each; flags only.");
  return ExitCode::kOk;
}

/// One page for the whole, one for each verb.
void writeManuals(const CLI::App& app, const io::StagedOutput& output) {
  io::writeText(output.path("agricolmap.1"), manualPage(app, nullptr));
  for (const CLI::App* verb : verbsOf(app)) {
    io::writeText(output.path("agricolmap-" + verb->get_name() + ".1"), manualPage(app, verb));
  }
}

}  // namespace

// For those who change options or make packages, not for those who set them: hidden from the help.
CommandSlot addDocumentCommand(CLI::App& app, const Globals&) {
  CLI::App* command = app.add_subcommand("document-options", "Print docs/options.md");
  command->group("");
  return {command, [] { return runDocument(); }};
}

CommandSlot addManualsCommand(CLI::App& app, const Globals& globals) {
  CLI::App* command = app.add_subcommand("document-manuals", "Write manual pages");
  command->group("");
  auto folder = std::make_shared<std::string>();
  command->add_option("FOLDER", *folder, "Where to")->required();
  return {command, [&app, &globals, folder] {
            io::StagedOutput output(*folder, globals.overwrite);
            writeManuals(app, output);
            output.commit();
            return ExitCode::kOk;
          }};
}

CommandSlot addCompletionCommand(CLI::App& app, const Globals&) {
  CLI::App* command = app.add_subcommand("document-completion", "Print a shell's completions");
  command->group("");
  auto shell = std::make_shared<std::string>();
  command->add_option("SHELL", *shell, "bash or zsh")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh"}));
  return {command, [&app, shell] {
            fmt::print("{}", *shell == "bash" ? bashCompletion(app) : zshCompletion(app));
            return ExitCode::kOk;
          }};
}

}  // namespace agricolmap
