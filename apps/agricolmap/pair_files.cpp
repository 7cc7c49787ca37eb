#include "pair_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap {
namespace {

constexpr std::array kFormats{io::CloudFormat::kPly, io::CloudFormat::kPcd, io::CloudFormat::kLas,
                              io::CloudFormat::kLaz};

bool isLas(io::CloudFormat format) {
  return format == io::CloudFormat::kLas || format == io::CloudFormat::kLaz;
}

io::CloudFormat formatOf(const std::string& path) {
  return io::formatByContent(io::MappedFile(path).text()).value_or(io::CloudFormat::kPly);
}

std::string nameOfAligned(io::CloudFormat format) { return "aligned." + io::endingOf(format); }

}  // namespace

void PairFiles::addTo(CLI::App& command) {
  command.add_option("FIXED", fixed, "The wide map: LAS, LAZ, PLY or PCD");
  command.add_option("MOVING", moving, "The map to be moved: LAS, LAZ, PLY or PCD");
  command.add_option("--fixed-crs", fixed_crs,
                     "Coordinate system of FIXED: EPSG:32632, WKT or a file with it. Default: what "
                     "the file or a .prj beside it says, else that of MOVING");
  command.add_option("--moving-crs", moving_crs, "The same of MOVING; brought to that of FIXED");
  command.add_option(
      "--aligned-format", aligned,
      "Format of the aligned cloud: ply, pcd, las, laz, or auto: las or laz as MOVING is, "
      "else ply [auto]");
}

void PairFiles::check() const {
  if (aligned == "auto" || std::any_of(kFormats.begin(), kFormats.end(), [&](auto format) {
        return aligned == io::endingOf(format);
      })) {
    return;
  }
  throw UsageError(
      fmt::format("--aligned-format {}: is none of ply, pcd, las, laz and auto", aligned));
}

LoadedPair loadPair(const PairFiles& files,
                    const std::function<void(std::size_t, std::size_t)>& on_pass) {
  LoadedPair pair;
  const io::FileCrs fixed = io::crsOf(files.fixed, files.fixed_crs);
  const io::FileCrs moving = io::crsOf(files.moving, files.moving_crs);
  pair.frame = io::commonFrame(fixed, moving);
  const io::CloudFormat own = formatOf(files.moving);
  pair.aligned = isLas(own) ? own : io::CloudFormat::kPly;
  for (const io::CloudFormat format : kFormats) {
    if (files.aligned == io::endingOf(format)) pair.aligned = format;
  }
  // Two files, two cores: the disk cache feeds both.
  parallelFor(2, [&](std::size_t i) {
    if (i == 0) {
      io::StreamOptions options;
      options.read.map = pair.frame.fixed.get();
      options.on_pass = on_pass;
      options.crs = pair.frame.crs;
      pair.fixed = io::streamCloud(files.fixed, options);
    } else {
      pair.moving = io::readCloud(files.moving, {true, pair.frame.moving.get()});
      pair.moving.crs = pair.frame.crs;
    }
  });
  const CloudFacts& fixed_facts = pair.fixed->facts();
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
  if (!isLas(pair.aligned) || !isLas(formatOf(files.moving))) {
    io::writeCloud(path, pair.moving, pair.aligned, fixed_from_moving);
    return {};
  }
  io::LasMove move;
  move.map = pair.frame.moving.get();
  move.target_from_file = fixed_from_moving;
  move.origin = pair.moving.origin;
  move.crs = pair.frame.crs;
  io::LasCopied copied =
      io::copyLas(files.moving, path, pair.aligned == io::CloudFormat::kLaz, move);
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

}  // namespace agricolmap
