#include "agricolmap/run/pair_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/cloud/move_file.hpp"
#include "agricolmap/io/raster/map_files.hpp"

namespace agricolmap::run {
namespace {

constexpr std::array kFormats{io::CloudFormat::kPly, io::CloudFormat::kPcd, io::CloudFormat::kLas,
                              io::CloudFormat::kLaz, io::CloudFormat::kCopc};

std::string nameOfAligned(io::CloudFormat format) { return "aligned." + io::endingOf(format); }

}  // namespace

io::CloudFormat formatNamed(const std::string& of, const std::string& name) {
  for (const io::CloudFormat format : kFormats) {
    const std::string ending = io::endingOf(format);
    if (name == ending.substr(0, ending.find('.'))) return format;
  }
  throw UsageError(fmt::format("{} {}: is none of ply, pcd, las, laz, copc and auto", of, name));
}

std::shared_ptr<const LoadedFixed> streamedFixed(
    const io::MapFiles& files, const io::CommonFrame& frame,
    const std::function<void(std::size_t, std::size_t)>& on_pass) {
  io::StreamOptions options;
  options.read.map = frame.fixed.get();
  options.on_pass = on_pass;
  options.crs = frame.crs;
  return std::make_shared<const LoadedFixed>(io::streamMap(files, options));
}

io::CommonFrame frameOf(const PairFiles& files) {
  return io::commonFrame(io::crsOfMap(io::mapFilesOf(files.fixed), files.fixed_crs),
                         io::crsOfMap(io::mapFilesOf(files.moving), files.moving_crs));
}

LoadedPair loadPair(const PairFiles& files, const FixedSource& fixed_source) {
  LoadedPair pair;
  const io::MapFiles fixed_files = io::mapFilesOf(files.fixed);
  const io::MapFiles moving_files = io::mapFilesOf(files.moving);
  pair.frame = frameOf(files);
  if (!moving_files.raster) pair.format = io::formatOf(moving_files.main);
  if (pair.format && io::isLas(*pair.format)) pair.aligned = *pair.format;
  if (files.aligned != "auto") pair.aligned = formatNamed("aligned", files.aligned);
  // Two files, two cores: the disk cache feeds both.
  parallelFor(2, [&](std::size_t i) {
    if (i == 0) {
      pair.fixed = fixed_source(fixed_files, pair.frame);
    } else {
      pair.moving = io::readMap(moving_files, {true, pair.frame.moving.get()});
      pair.moving.crs = pair.frame.crs;
    }
  });
  const CloudFacts& fixed_facts = pair.fixed->cloud.facts();
  io::checkGroundScale(fixed_facts.name, pair.frame.crs, fixed_facts.origin.head<2>());
  return pair;
}

std::vector<std::string> alignedNames() {
  std::vector<std::string> names;
  for (const io::CloudFormat format : kFormats) names.push_back(nameOfAligned(format));
  return names;
}

std::vector<std::string> writeAligned(const PairFiles& files, const LoadedPair& pair,
                                      const io::PointMove& fixed_from_moving,
                                      const io::StagedOutput& output) {
  const io::OutputPath path = output.path(nameOfAligned(pair.aligned));
  if (!pair.format || !io::keepsAttributes(*pair.format, pair.aligned)) {
    io::writeCloud(path, pair.moving, pair.aligned, fixed_from_moving);
    return {};
  }
  io::CopiedCloud copied = io::moveFile(
      io::mapFilesOf(files.moving).main, path, pair.aligned,
      {pair.frame.moving.get(), pair.moving.origin, fixed_from_moving, pair.frame.crs});
  if (copied.left_out > 0) {
    copied.warnings.push_back(
        fmt::format("{}: {} points were left out of the aligned cloud: too far from the others",
                    files.moving, copied.left_out));
  }
  return copied.warnings;
}

std::string transformComment(const LoadedPair& pair) {
  if (pair.frame.crs.wkt.empty()) return "";
  return fmt::format(
      "p_fixed = M * p_moving, metres in {}{}", pair.frame.crs.name,
      pair.frame.moving_reprojected ? ", to which MOVING was reprojected first" : "");
}

}  // namespace agricolmap::run
