// agricolmap diff MAP_A MAP_B -o DIR

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "change_files.hpp"
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
  bool no_pictures = false;
};

std::optional<GivenError> givenError(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return GivenError{.height = values[0], .plane = values[1]};
}

enum class Summary { kMedian, kMean };

double summaryOf(std::vector<float>& values, Summary summary) {
  if (values.empty()) return 0.0;
  if (summary == Summary::kMedian) return static_cast<double>(median(values));
  double sum = 0.0;
  for (const float value : values) sum += static_cast<double>(value);
  return sum / static_cast<double>(values.size());
}

/// Nothing where one of the maps has no such layer.
std::optional<report::LayerTimes> readPair(const char* layer, const ChangeMap& a,
                                           const ChangeMap& b, const CommonGround& ground) {
  auto before = a.layerOn(layer, ground.frame, ground.origin);
  auto after = b.layerOn(layer, ground.frame, ground.origin);
  if (!before || !after) return std::nullopt;
  return report::LayerTimes{*std::move(before), *std::move(after)};
}

/// `among`: the cells that the summary is of; nullptr: all.
LayerChange changeOf(report::LayerTimes times, Summary summary, const Raster<std::uint8_t>* among) {
  LayerChange found{std::move(times), {}};
  const report::LayerTimes& pair = found.times;
  found.change = Raster<float>(pair.before.rows(), pair.before.cols());
  std::vector<float> before;
  std::vector<float> after;
  for (std::size_t i = 0; i < found.change.size(); ++i) {
    found.change[i] = pair.after[i] - pair.before[i];
    if (std::isnan(found.change[i]) || (among != nullptr && (*among)[i] == 0)) continue;
    before.push_back(pair.before[i]);
    after.push_back(pair.after[i]);
  }
  found.cells = before.size();
  found.before = summaryOf(before, summary);
  found.after = summaryOf(after, summary);
  return found;
}

/// 1 where more than half of the cell is vegetation in both maps.
Raster<std::uint8_t> plantsIn(const report::LayerTimes& covers) {
  Raster<std::uint8_t> plants(covers.before.rows(), covers.before.cols());
  for (std::size_t i = 0; i < plants.size(); ++i) {
    plants[i] = covers.before[i] > 0.5F && covers.after[i] > 0.5F ? 1 : 0;
  }
  return plants;
}

/// What two drone's maps lie apart is in no map's errors.
void warnOfFrames(const ChangeMap& a, const ChangeMap& b, bool given,
                  std::vector<std::string>& warnings) {
  if (given || !a.folder() || !b.folder()) return;
  if (a.folder()->hasFixedOf(*b.folder())) return;
  warnings.push_back(fmt::format(
      "{} and {} do not hang on one drone map, and what two of them lie apart is in neither's "
      "errors; say what is expected of it, in metres: --frame-error HEIGHT PLANE",
      a.name(), b.name()));
}

MapChange compare(const DiffArguments& arguments, Progress& progress,
                  std::vector<std::string>& warnings) {
  const ChangeMap a(arguments.map_a, givenError(arguments.error_a), "--error-a");
  const ChangeMap b(arguments.map_b, givenError(arguments.error_b), "--error-b");
  MapChange found;
  found.name_a = arguments.map_a;
  found.name_b = arguments.map_b;
  found.ground = commonGroundOf(a, b, warnings);
  warnOfFrames(a, b, !arguments.frame_error.empty(), warnings);
  if (const auto frames = givenError(arguments.frame_error)) {
    found.frames = {.plane = frames->plane, .height = frames->height};
  }
  const GridFrame& grid = found.ground.frame;
  const Eigen::Vector3d& origin = found.ground.origin;
  progress.step("reading the maps");
  change::MapHeights heights_a = a.heightsOn(grid, origin, warnings);
  change::MapHeights heights_b = b.heightsOn(grid, origin, warnings);
  std::optional<Raster<std::uint8_t>> bare;
  std::optional<Raster<std::uint8_t>> planted;
  if (auto covers = readPair("cover", a, b, found.ground)) {
    bare = change::bareGround(covers->before, covers->after);
    planted = plantsIn(*covers);
    found.cover = changeOf(*std::move(covers), Summary::kMean, nullptr);
  }
  if (auto plants = readPair("plant_height", a, b, found.ground)) {
    found.plant_height =
        changeOf(*std::move(plants), Summary::kMedian, planted ? &*planted : nullptr);
  }
  if (!arguments.no_pictures) {
    found.colour_before = a.coloursOn(grid, origin);
    found.colour_after = b.coloursOn(grid, origin);
  }
  progress.step("comparing them");
  found.heights = change::heightChange(heights_a, heights_b, grid.cell, found.frames);
  found.totals = change::totalsOf(found.heights, heights_a, heights_b, grid.cell, found.frames,
                                  bare ? &*bare : nullptr);
  if (found.totals.compared.cells == 0) {
    throw InputError(
        fmt::format("{} and {} have no cell in common of which both know the surface and its error",
                    arguments.map_a, arguments.map_b));
  }
  found.surface = {std::move(heights_a.surface), std::move(heights_b.surface)};
  return found;
}

/// Ground that should not have moved, and moved by more than is expected.
void warnOfBareGround(const MapChange& found, std::vector<std::string>& warnings) {
  const auto& bare = found.totals.stable;
  if (!bare || bare->cells == 0) return;
  if (std::abs(bare->mean()) <= change::kLevel95 * bare->meanDeviation()) return;
  warnings.push_back(fmt::format(
      "bare ground changed by {:.1f} cm on average, and no more than {:.1f} cm is expected: it was "
      "worked, or the maps lie further apart than their errors say (--frame-error)",
      100.0 * bare->mean(), 100.0 * change::kLevel95 * bare->meanDeviation()));
}

ExitCode runDiff(const DiffArguments& arguments, const Globals& globals) {
  requirePictures(arguments.no_pictures);
  io::StagedOutput output(arguments.output, globals.overwrite);
  std::vector<std::string> warnings;
  std::optional<MapChange> found;
  {
    Progress progress(globals);
    found = compare(arguments, progress, warnings);
    warnOfBareGround(*found, warnings);
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
    command->add_option(flag, values, help)->expected(2)->check(CLI::Range(0.0, 100.0));
  };
  error("--error-a", arguments->error_a,
        "Expected RMS of the heights, and of the places, of MAP_A [m]; instead of its own");
  error("--error-b", arguments->error_b, "The same of MAP_B");
  error("--frame-error", arguments->frame_error,
        "Expected RMS between the frames of both maps, as of two flights: heights, places [m]");
  command->add_flag("--no-pictures", arguments->no_pictures, "Draw no picture");
  return {command, [arguments, &globals] { return runDiff(*arguments, globals); }};
}

}  // namespace agricolmap
