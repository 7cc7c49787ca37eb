// agricolmap facts MAP -o DIR: what stands on the field, counted and measured.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "agricolmap/crop/facts.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/vector/vector_layer.hpp"
#include "agricolmap/report/facts/facts_layers.hpp"
#include "agricolmap/report/page/facts_page.hpp"
#include "agricolmap/report/pictures/facts_picture.hpp"
#include "common.hpp"
#include "facts_input.hpp"
#include "option_flags.hpp"

namespace agricolmap {
namespace {

constexpr const char* kPage = "facts.html";
constexpr const char* kPicture = "facts.png";
constexpr const char* kBrapi = "brapi.geojson";
constexpr const char* kPlots = "plots.csv";

struct FactsArguments {
  std::string map;
  std::string output;
  std::string plots;
  std::string crs;
  bool no_pictures = false;
  OptionFlags flags;
};

std::vector<crop::Plot> readPlots(const std::string& path, const FactsInput& input) {
  std::vector<crop::Plot> plots;
  if (path.empty()) return plots;
  for (io::NamedPolygon& polygon : io::readPolygons(path, input.crs)) {
    for (Eigen::Vector2d& corner : polygon.corners) corner -= input.layers.origin;
    plots.push_back({std::move(polygon.id), std::move(polygon.corners)});
  }
  return plots;
}

/// Plots of another field, or in another system than they say, would count nothing and look as if
/// nothing stood there.
void requirePlotsOnMap(const FactsArguments& arguments, const crop::FieldFacts& facts) {
  const auto shows = [](const crop::StandFacts& plot) { return plot.area > 0.0; };
  if (facts.per_plot.empty() || std::ranges::any_of(facts.per_plot, shows)) return;
  throw InputError(
      fmt::format("{}: {} shows nothing of its {} plots; give those of this field, and see that "
                  "their coordinate system is the one that the file says",
                  arguments.plots, arguments.map, facts.per_plot.size()));
}

void writeFiles(const io::StagedOutput& output, const report::PlacedFacts& placed,
                const std::vector<io::VectorLayer>& layers) {
  io::writeGeoPackage(output.path("facts.gpkg"), layers, placed.crs);
  for (const io::VectorLayer& layer : layers) {
    io::writeCsv(output.path(layer.name + ".csv"), layer);
  }
  io::writeText(output.path("facts.json"), report::factsJson(placed).dump(2) + "\n");
  const nlohmann::ordered_json brapi = report::brapiJson(placed);
  if (!brapi.is_null()) io::writeText(output.path(kBrapi), brapi.dump(1) + "\n");
}

void writePage(const io::StagedOutput& output, const FactsArguments& arguments,
               const FactsInput& input, const report::PlacedFacts& placed,
               const std::vector<io::VectorLayer>& layers, const Globals& globals) {
  const report::FactsGround ground{input.layers.frame, placed.facts.greenness.green,
                                   input.layers.height, input.colours};
  report::FactsPageInfo info;
  info.map_page = wayTo(input.map_page, output.directory());
  info.command_line = globals.command_line;
  info.version = AGRICOLMAP_VERSION;
  nlohmann::ordered_json scene = report::factsScene(layers, placed.origin);
  if (!arguments.no_pictures) report::addFactsPictures(scene, ground);
  io::writeText(output.path(kPage), report::factsPage(report::factsJson(placed), std::move(scene),
                                                      report::factsText(placed), info));
}

ExitCode runFacts(const FactsArguments& arguments, const Globals& globals) {
  crop::FactsOptions options;
  arguments.flags.apply(optionTable(options));
  requirePictures(arguments.no_pictures);
  io::StagedOutput output(arguments.output, globals.overwrite);
  Progress progress(globals);
  progress.step("read");
  FactsInput input = readFactsInput(arguments.map, arguments.crs, progress);
  const std::vector<crop::Plot> plots = readPlots(arguments.plots, input);
  progress.step("look");
  crop::FieldLayers& layers = input.layers;
  crop::bringToGround(layers, options.vegetation);
  const crop::FieldFacts facts = crop::factsOf(layers.view(), layers.origin, plots, options);
  if (!facts.greenness.known()) {
    throw InputError(fmt::format("{}: no crop facts: {}", arguments.map,
                                 map::toString(facts.greenness.threshold.status)));
  }
  requirePlotsOnMap(arguments, facts);
  const report::PlacedFacts placed{facts, layers.origin, plots, input.crs, arguments.map};
  progress.step("write");
  const std::vector<io::VectorLayer> things = report::factsLayers(placed);
  writeFiles(output, placed, things);
  writePage(output, arguments, input, placed, things, globals);
  if (!arguments.no_pictures) {
    report::writeFactsPicture(output.path(kPicture), layers.frame, placed);
  }
  output.commit({kPicture, kBrapi, kPlots});
  if (!globals.quiet) fmt::print("{}", report::factsText(placed));
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addFactsCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<FactsArguments>();
  CLI::App* command = app.add_subcommand(
      "facts", "Count and measure what stands on a field: rows, plants, gaps, heights, weeds");
  command
      ->add_option("MAP", arguments->map,
                   "Folder of a map with its layers, or a cloud, or ORTHO.tif,DSM.tif")
      ->required();
  command->add_option("-o,--output", arguments->output, "Folder for the results")->required();
  command->add_option("--plots", arguments->plots,
                      "Polygons to count in, too: GeoPackage, GeoJSON, shapefile, ...");
  command->add_option("--crs", arguments->crs,
                      "Coordinate system of a cloud that does not say its own: EPSG:32632, ...");
  command->add_flag("--no-pictures", arguments->no_pictures, "Write no PNG picture");
  crop::FactsOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "What is looked for");
  return {command, [arguments, &globals] { return runFacts(*arguments, globals); }};
}

}  // namespace agricolmap
