// agricolmap fuse FIXED RUN_DIR... -o MAP
#include <fmt/format.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <set>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/fuse/cloud_file.hpp"
#include "agricolmap/fuse/layer_files.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/report/gis/layer_styles.hpp"
#include "agricolmap/report/page/shared_map_page.hpp"
#include "agricolmap/report/pictures/shared_map_picture.hpp"
#include "agricolmap/run/pair_files.hpp"
#include "common.hpp"
#include "fuse_sources.hpp"
#include "option_flags.hpp"

namespace agricolmap {
namespace {

struct FuseArguments {
  FuseFiles files;
  std::string output;
  std::string config;
  std::string cloud = "auto";
  bool dump_config = false;
  bool no_pictures = false;
  OptionFlags flags;
};

/// Of the fused cloud; nothing where none is wanted.
std::optional<io::CloudFormat> cloudFormat(const std::string& name) {
  if (name == "none") return std::nullopt;
  if (name == "auto") {
    return storedFormat() == io::CloudFormat::kLas ? io::CloudFormat::kLas : io::CloudFormat::kCopc;
  }
  const io::CloudFormat format = run::formatNamed("--cloud-format", name);
  if (io::isLas(format)) return format;
  throw UsageError(
      fmt::format("--cloud-format {}: the fused cloud is las, laz, copc or none; "
                  "agricolmap convert makes others of it",
                  name));
}

fuse::FuseOptions chosenOptions(const FuseArguments& arguments) {
  fuse::FuseOptions options;
  OptionTable table = optionTable(options);
  if (!arguments.config.empty()) config::loadYaml(arguments.config, table);
  arguments.flags.apply(table);
  return options;
}

std::vector<fuse::StripInput> inputsOf(const MapPlan& plan, const MapClouds& clouds) {
  std::vector<fuse::StripInput> inputs;
  for (std::size_t i = 0; i < plan.strips.size(); ++i) {
    const report::MapSource& source = plan.strips[i].source;
    inputs.push_back(
        {source.id, clouds.strips[i].get(), source.date, source.errors, source.heights_limited});
  }
  return inputs;
}

fuse::StripPoints pointsOf(const MapClouds& clouds) {
  fuse::StripPoints points;
  for (const auto& strip : clouds.strips) points.push_back(strip.get());
  return points;
}

/// What a fused map of another run would have written: these go when they are not written again.
bool isForeign(const std::filesystem::path& name) {
  static const std::set<std::string> kFolders{"layers", "fine", "strips"};
  static const std::set<std::string> kFiles{"map.json",  "map.html",       "map.png",  "cloud.las",
                                            "cloud.laz", "cloud.copc.laz", "cloud.ply"};
  return !kFolders.contains(name.begin()->string()) && !kFiles.contains(name.string());
}

report::MapFacts writeMap(const io::SwappedFolder& folder, const MapPlan& plan,
                          const MapClouds& clouds, const fuse::SharedMap& map,
                          const std::vector<fuse::StripInput>& inputs,
                          std::optional<io::CloudFormat> format, const fuse::FuseOptions& options,
                          Progress& progress) {
  report::MapFacts facts;
  facts.crs = clouds.crs;
  facts.fixed = plan.fixed;
  for (const MapStrip& strip : plan.strips) facts.strips.push_back(strip.source);
  progress.step("write layers");
  const auto place = [&](const std::string& name) { return folder.path(name); };
  facts.layers = fuse::writeLayers(place, map, pointsOf(clouds), options, clouds.crs);
  report::writeMapStyles(place, map);
  if (!format) return facts;
  progress.step("write cloud");
  facts.cloud = "cloud." + io::endingOf(*format);
  const fuse::PointCounts counts =
      fuse::writeFusedCloud(folder.path(facts.cloud), folder.path(".points.las"), *format, map,
                            *clouds.fixed, plan.fixed.date, inputs, options, clouds.crs);
  facts.fixed.kept = counts[0];
  for (std::size_t i = 0; i < facts.strips.size(); ++i) facts.strips[i].kept = counts[i + 1];
  return facts;
}

void printSummary(const fuse::SharedMap& map, const report::MapFacts& facts,
                  const std::string& output) {
  fmt::print(
      "{} strip{} in a map of {:.0f} x {:.0f} m, cells of {:.3g} m and, in strips, {:.3g} m\n",
      map.strips.size(), map.strips.size() == 1 ? "" : "s",
      map.layers.frame.cols * map.layers.frame.cell, map.layers.frame.rows * map.layers.frame.cell,
      map.layers.frame.cell, map.layers.frame.cell / map.lattice.factor);
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    const fuse::FusedStrip& strip = map.strips[i];
    std::string more;
    if (!facts.cloud.empty()) more += fmt::format(", {} points", facts.strips[i].kept);
    if (!strip.moved.isZero()) {
      more += fmt::format(", moved by {:.1f} cm to fit the others", 100.0 * strip.moved.norm());
    }
    if (facts.strips[i].heights_limited) more += ", its heights are limited";
    fmt::print("  {}: has {:.1f} of the {:.1f} m2 that it saw{}\n", strip.id, strip.owned_area,
               strip.seen_area, more);
  }
  if (map.bias && !map.bias->curves[1].empty()) {
    const fuse::HeightCurve& plants = map.bias->curves[1];
    fmt::print(
        "  FIXED lies {:+.1f} to {:+.1f} cm off over plants, which is undone elsewhere, too\n",
        -100.0 * *std::max_element(plants.shift.begin(), plants.shift.end()),
        -100.0 * *std::min_element(plants.shift.begin(), plants.shift.end()));
  }
  fmt::print("the map is in {}\n", output);
}

ExitCode runFuse(const FuseArguments& arguments, const Globals& globals) {
  const fuse::FuseOptions options = chosenOptions(arguments);
  if (arguments.dump_config) {
    fuse::FuseOptions copy = options;
    std::cout << config::dumpYaml(optionTable(copy));
    return ExitCode::kOk;
  }
  const std::optional<io::CloudFormat> format = cloudFormat(arguments.cloud);
  requirePictures(arguments.no_pictures);
  // First of all, as nobody else may change the map meanwhile.
  io::SwappedFolder folder(arguments.output);
  MapPlan plan = planMap(arguments.files, folder.directory(), globals.overwrite);
  Progress progress(globals);
  progress.step("read");
  const MapClouds clouds = openClouds(arguments.files, plan, folder);
  printWarnings(plan.warnings);
  const std::vector<fuse::StripInput> inputs = inputsOf(plan, clouds);
  const StopScope scope(globals.stop);
  const fuse::SharedMap map = fuse::shareMap(*clouds.fixed, plan.fixed.date, inputs, options,
                                             [&](std::string_view step) { progress.step(step); });
  printWarnings(map.warnings);
  report::MapFacts facts = writeMap(folder, plan, clouds, map, inputs, format, options, progress);
  facts.command_line = globals.command_line;
  facts.version = AGRICOLMAP_VERSION;
  if (!arguments.no_pictures) {
    progress.step("picture");
    report::writeSharedMapPicture(folder.path("map.png"), map, pointsOf(clouds), arguments.output);
  }
  const std::string json = report::sharedMapJson(map, facts, options);
  io::writeText(folder.path("map.json"), json);
  io::writeText(
      folder.path("map.html"),
      report::sharedMapPage(json, arguments.no_pictures ? nullptr : report::sharedMapScene(map)));
  throwIfInterrupted();
  folder.keepOthers(isForeign);
  folder.commit();
  if (!globals.quiet) printSummary(map, facts, arguments.output);
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addFuseCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<FuseArguments>();
  CLI::App* command = app.add_subcommand(
      "fuse",
      "Make one map of a drone's cloud and the strips that were registered to it, or update "
      "one");
  arguments->files.addTo(*command);
  command->add_option("-o,--output", arguments->output, "Folder of the map")->required();
  command->add_option("--cloud-format", arguments->cloud,
                      "Format of the fused cloud: copc, laz, las, none, or auto: copc where there "
                      "is LASzip, else las [auto]");
  command->add_option("--config", arguments->config, "YAML file with options");
  command->add_flag("--dump-config", arguments->dump_config,
                    "Print all options in force as YAML and stop");
  command->add_flag("--no-pictures", arguments->no_pictures, "Write no PNG picture");
  fuse::FuseOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options of the map");
  return {command, [arguments, &globals] { return runFuse(*arguments, globals); }};
}

}  // namespace agricolmap
