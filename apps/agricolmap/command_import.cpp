// agricolmap import ORTHO.tif DSM.tif -o CLOUD.ply
#include <fmt/format.h>

#include <memory>

#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/raster/raster_import.hpp"
#include "common.hpp"
#include "option_flags.hpp"

namespace agricolmap {
namespace {

struct ImportArguments {
  std::string ortho;
  std::string dsm;
  std::string output;
  OptionFlags flags;
};

ExitCode runImport(const ImportArguments& arguments, const Globals& globals) {
  io::ImportOptions options;
  arguments.flags.apply(optionTable(options));
  io::StagedFile output(arguments.output, globals.overwrite);
  Progress progress(globals);
  progress.step("import");
  const Cloud cloud = io::importOrthoDsm(arguments.ortho, arguments.dsm, options);
  printWarnings(cloud.warnings);
  io::writePly(output.path(), cloud);
  output.commit();
  if (!globals.quiet) {
    fmt::print("{}: {} points, {} pixels without a height left out\n", arguments.output,
               cloud.size(), cloud.dropped_points);
  }
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addImportCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = app.add_subcommand(
      "import", "Make a cloud from an orthomosaic and a surface model (OpenDroneMap, Pix4D)");
  command->add_option("ORTHO", arguments->ortho, "Orthomosaic: GeoTIFF in projected metres")
      ->required();
  command->add_option("DSM", arguments->dsm, "Surface model: GeoTIFF, same coordinate system")
      ->required();
  command->add_option("-o,--output", arguments->output, "PLY to write")->required();
  io::ImportOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options of the import");
  return {command, [arguments, &globals] { return runImport(*arguments, globals); }};
}

}  // namespace agricolmap
