// agricolmap convert IN OUT, and import ORTHO.tif DSM.tif -o OUT, which is a case of it
#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/cloud/move_file.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "common.hpp"
#include "option_flags.hpp"

namespace agricolmap {
namespace {

struct ConvertArguments {
  std::vector<std::string> files;  ///< one or two to read, the last to write
  std::string output;              ///< import: instead of the last
  std::string crs;
  std::string to_crs;
  OptionFlags flags;
};

io::CloudFormat formatToWrite(const std::string& path) {
  if (const auto format = io::formatByEnding(path)) return *format;
  throw UsageError(fmt::format(
      "{}: its ending tells no format; known are .ply, .pcd, .las, .laz and .copc.laz", path));
}

/// How the coordinates of the source are read.
struct Reading {
  io::FileCrs crs;
  std::optional<io::CommonFrame> frame;  ///< that they are brought into, if into another

  const io::CoordinateMap* map() const { return frame ? frame->moving.get() : nullptr; }
};

/// From LAS to LAS point by point, with all that they have.
io::CopiedCloud copyLas(const std::string& from, const io::OutputPath& to, io::CloudFormat format,
                        const Reading& reading, const Crs& crs, Progress& progress) {
  std::optional<io::CloudMove> move;
  if (reading.frame) {
    // Looked at for its origin alone: what is far from the others is left out as it is there.
    io::StreamOptions look{{false, reading.map()}, 0, progress.ofPasses(), {}};
    move.emplace();
    move->map = reading.map();
    move->origin = io::factsOfFile(from, look).origin;
    move->crs = reading.frame->crs;
  }
  return io::copyLas(from, to, format, move, crs, progress.ofPasses());
}

/// Coordinates and colours of a cloud, which passes by, or of a raster, which is kept.
std::unique_ptr<PointStream> pointsIn(const ConvertArguments& arguments, const io::MapFiles& from,
                                      const Reading& reading, Progress& progress) {
  Crs crs = reading.crs.crs.value_or(Crs());
  if (reading.frame) crs = reading.frame->crs;
  if (!from.raster) {
    return io::streamCloud(from.main,
                           {{true, reading.map()}, io::kKeepLittle, progress.ofPasses(), crs});
  }
  io::ImportOptions options;
  arguments.flags.apply(optionTable(options));
  Cloud cloud = !reading.frame && arguments.crs.empty()
                    ? io::importOrthoDsm(from.main, from.model, options)
                    : io::readMap(from, {true, reading.map()}, options);
  if (reading.frame || reading.crs.crs) cloud.crs = crs;
  return io::keptStream(std::move(cloud));
}

io::CopiedCloud convertMap(const ConvertArguments& arguments, const io::MapFiles& from,
                           const io::OutputPath& to, io::CloudFormat format, Progress& progress) {
  Reading reading;
  reading.crs = io::crsOfMap(from, arguments.crs);
  const std::optional<Crs>& crs = reading.crs.crs;
  if (!arguments.to_crs.empty()) reading.frame = io::frameIn(reading.crs, arguments.to_crs);
  printWarnings(reading.frame ? reading.frame->warnings : reading.crs.warnings);
  const auto source = io::formatByContent(io::MappedFile(from.main).text());
  if (source && io::isLas(*source) && io::isLas(format)) {
    // COPC has no place for GeoTIFF keys: what they say is written as WKT.
    const bool anew = !arguments.crs.empty() || format == io::CloudFormat::kCopc;
    return copyLas(from.main, to, format, reading, anew && crs ? *crs : Crs(), progress);
  }
  if (!reading.frame && crs && !io::isProjected(*crs)) {
    throw InputError(fmt::format(
        "{}: its coordinates are degrees ({}), which are kept from LAS to LAS alone; bring them "
        "into a projected system (--to-crs EPSG:326<zone>: UTM north; 327<zone> south)",
        from.main.string(), crs->name));
  }
  const auto points = pointsIn(arguments, from, reading, progress);
  const CloudFacts& facts = points->facts();
  warnOfLostCrs(to.shown(), format, facts.crs);
  io::writeCloud(to, *points, format);
  return {facts.points, facts.dropped_points, facts.warnings};
}

ExitCode runConvert(ConvertArguments arguments, const Globals& globals) {
  if (arguments.output.empty()) {
    arguments.output = arguments.files.back();
    arguments.files.pop_back();
  }
  const io::MapFiles from = arguments.files.size() == 2
                                ? io::MapFiles{arguments.files[0], arguments.files[1], true}
                                : io::mapFilesOf(arguments.files.front());
  if (!from.raster && !arguments.flags.given().empty()) {
    throw UsageError(fmt::format("{} would do nothing: it needs ORTHO.tif and DSM.tif",
                                 flagOf(arguments.flags.given().front())));
  }
  const io::CloudFormat format = formatToWrite(arguments.output);
  io::StagedFile output(arguments.output, globals.overwrite);
  Progress progress(globals);
  progress.step(from.raster ? "import" : "convert");
  const io::CopiedCloud written = convertMap(arguments, from, output.path(), format, progress);
  printWarnings(written.warnings);
  output.commit();
  if (!globals.quiet) {
    fmt::print("{}: {} points, {} {}\n", arguments.output, written.points, written.left_out,
               from.raster ? "pixels without a height left out" : "left out");
  }
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addConvertCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert", "Write a cloud, or an orthomosaic with its surface model, in another format");
  command
      ->add_option(
          "FILES", arguments->files,
          "IN OUT, or ORTHO.tif DSM.tif OUT; IN may be text and ORTHO.tif, too; OUT ends in .ply, "
          ".pcd, .las, .laz or .copc.laz")
      ->required()
      ->expected(2, 3);
  command->add_option("--crs", arguments->crs,
                      "Coordinate system of IN: EPSG:32632, WKT or a file with it, instead of what "
                      "it says");
  command->add_option("--to-crs", arguments->to_crs,
                      "Coordinate system to bring coordinates into, in metres");
  io::ImportOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options for rasters");
  return {command, [arguments, &globals] { return runConvert(*arguments, globals); }};
}

CommandSlot addImportCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<ConvertArguments>();
  arguments->files.resize(2);
  CLI::App* command = app.add_subcommand(
      "import", "Make a cloud from an orthomosaic and a surface model (OpenDroneMap, Pix4D)");
  command->add_option("ORTHO", arguments->files[0], "Orthomosaic: GeoTIFF in projected metres")
      ->required();
  command->add_option("DSM", arguments->files[1], "Surface model: GeoTIFF, same coordinate system")
      ->required();
  command->add_option("-o,--output", arguments->output, "PLY, PCD, LAS, LAZ or COPC to write")
      ->required();
  io::ImportOptions defaults;
  arguments->flags.addTo(*command, optionTable(defaults), "Options of the import");
  return {command, [arguments, &globals] { return runConvert(*arguments, globals); }};
}

}  // namespace agricolmap
