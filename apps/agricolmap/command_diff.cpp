// agricolmap diff MAP_A MAP_B -o DIR

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "agricolmap/io/output/staged_output.hpp"
#include "change_files.hpp"
#include "change_zones.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

struct DiffArguments {
  std::string map_a;
  std::string map_b;
  std::string output;
  std::vector<double> error_a;
  std::vector<double> error_b;
  std::vector<double> frame_error;
  ZonesAsked zones;
  bool no_pictures = false;
};

std::optional<GivenError> givenError(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return GivenError{.height = values[0], .plane = values[1]};
}

/// What two drone's maps lie apart is in no map's errors.
void warnOfFrames(const ChangeMap& a, const ChangeMap& b, bool given,
                  std::vector<std::string>& warnings) {
  if (given || a.flat() || b.flat() || !a.folder() || !b.folder()) return;
  if (a.folder()->hasFixedOf(*b.folder())) return;
  warnings.push_back(fmt::format(
      "{} and {} do not hang on one drone map, and what two of them lie apart is in neither's "
      "errors; say what is expected of it, in metres: --frame-error HEIGHT PLANE",
      a.name(), b.name()));
}

/// Greenness is then all that can be compared.
bool withoutHeights(const ChangeMap& a, const ChangeMap& b, std::vector<std::string>& warnings) {
  if (!a.flat() && !b.flat()) return false;
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    if (!one->folder()) {
      throw InputError(
          fmt::format("{} is a surface, and {} has no heights: they have nothing in common",
                      one->name(), other->name()));
    }
    if (one->flat() && !other->flat()) {
      warnings.push_back(one->name() + ": has no heights, so only greenness is compared");
    }
  }
  return true;
}

/// All that is compared of a map, on the common grid.
change::MapLayers layersOf(const ChangeMap& map, const CommonGround& ground, bool flat,
                           std::vector<std::string>& warnings) {
  const GridFrame& grid = ground.frame;
  change::MapLayers layers{flat ? change::noHeights(grid)
                                : map.heightsOn(grid, ground.origin, warnings)};
  layers.cover = map.layerOn("cover", grid, ground.origin);
  if (!flat) layers.plant_height = map.layerOn("plant_height", grid, ground.origin);
  return layers;
}

MapChange compare(const DiffArguments& arguments, Progress& progress,
                  std::vector<std::string>& warnings) {
  const ChangeMap a(arguments.map_a, givenError(arguments.error_a), "--error-a");
  const ChangeMap b(arguments.map_b, givenError(arguments.error_b), "--error-b");
  MapChange found;
  found.name_a = arguments.map_a;
  found.name_b = arguments.map_b;
  const bool flat = withoutHeights(a, b, warnings);
  found.ground = commonGroundOf(a, b, warnings);
  warnOfFrames(a, b, !arguments.frame_error.empty(), warnings);
  const auto frames = givenError(arguments.frame_error).value_or(GivenError{});
  const GridFrame& grid = found.ground.frame;
  progress.step("reading the maps");
  change::MapLayers before = layersOf(a, found.ground, flat, warnings);
  change::MapLayers after = layersOf(b, found.ground, flat, warnings);
  if (!arguments.no_pictures) {
    found.colour_before = a.coloursOn(grid, found.ground.origin);
    found.colour_after = b.coloursOn(grid, found.ground.origin);
  }
  progress.step("comparing them");
  found.compared = change::compareMaps(std::move(before), std::move(after), grid.cell,
                                       {.plane = frames.plane, .height = frames.height}, flat);
  if (found.compared.comparedCells() == 0) {
    throw InputError(fmt::format("{} and {} have no cell in common of which both know {}",
                                 arguments.map_a, arguments.map_b,
                                 flat ? "the cover" : "the surface and its error"));
  }
  found.zones = changeByZones(arguments.zones, found);
  if (!flat) {
    found.surface = {std::move(found.compared.before.surface),
                     std::move(found.compared.after.surface)};
  }
  return found;
}

ExitCode runDiff(const DiffArguments& arguments, const Globals& globals) {
  requirePictures(arguments.no_pictures);
  io::StagedOutput output(arguments.output, globals.overwrite);
  std::vector<std::string> warnings;
  std::optional<MapChange> found;
  {
    Progress progress(globals);
    found = compare(arguments, progress, warnings);
    if (const auto moved = change::bareGroundWarning(found->compared.totals); !moved.empty()) {
      warnings.push_back(moved + " (--frame-error)");
    }
    progress.step("writing");
    writeChange(output.folder(), *found,
                {!arguments.no_pictures, output.directory(), warnings, globals.command_line});
  }
  output.commit(kChangeFiles);
  printWarnings(warnings);
  if (globals.quiet) return ExitCode::kOk;
  for (const report::ChangeFact& line : describe(*found)) {
    fmt::print("{:<11} {}\n", line.label, line.text);
  }
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addDiffCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<DiffArguments>();
  CLI::App* command =
      app.add_subcommand("diff", "Say what changed between two maps, and what is more than errors");
  command->add_option("MAP_A", arguments->map_a, "The map before: of fuse, or a surface model")
      ->required();
  command->add_option("MAP_B", arguments->map_b, "The map after")->required();
  command->add_option("-o,--output", arguments->output, "Folder for the results")->required();
  const auto error = [&](const char* flag, std::vector<double>& values, const char* help) {
    command->add_option(flag, values, help)
        ->expected(2)
        ->check(CLI::Range(0.0, change::kMostError));
  };
  error("--error-a", arguments->error_a,
        "Expected RMS of the heights, and of the places, of MAP_A [m]; instead of its own");
  error("--error-b", arguments->error_b, "The same of MAP_B");
  error("--frame-error", arguments->frame_error,
        "Expected RMS between the frames of both maps, as of two flights: heights, places [m]");
  command->add_option("--plots", arguments->zones.plots,
                      "Polygons to compare in, too: GeoPackage, GeoJSON, shapefile, ...");
  command
      ->add_option("--grid", arguments->zones.grid,
                   "Side of squares to compare in, too, on round coordinates [m]")
      ->check(CLI::Range(change::kLeastSquare, change::kMostSquare));
  command->add_flag("--no-pictures", arguments->no_pictures, "Draw no picture");
  return {command, [arguments, &globals] { return runDiff(*arguments, globals); }};
}

}  // namespace agricolmap
