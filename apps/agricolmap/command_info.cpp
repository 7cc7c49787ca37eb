// agricolmap info CLOUD, or of a shared map
#include <fmt/format.h>

#include <memory>
#include <string>

#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/core/stream_ranks.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "common.hpp"
#include "map_info.hpp"

namespace agricolmap {
namespace {

void printCrs(const io::FileCrs& file) {
  if (!file.crs) {
    fmt::print("system     not said; taken as metres\n");
    return;
  }
  fmt::print("system     {}", file.crs->name);
  if (!io::isProjected(*file.crs)) {
    fmt::print(" (no metres)");
  } else if (!io::isInMetres(*file.crs)) {
    fmt::print(" (units of {:.10g} m, heights of {:.10g} m)", file.crs->horizontal_unit,
               file.crs->vertical_unit);
  }
  fmt::print("\n");
}

/// Size of what all but one point in 500 lie in, along each axis [m].
Eigen::Vector3d mostOf(const PointStream& points) {
  constexpr std::size_t kTail = 1000;
  const Box3 box = boxWithoutTails(points, points.facts().points / kTail);
  return box.max.cast<double>() - box.min.cast<double>();
}

/// What all points together say.
struct Look {
  CloudFacts facts;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  Eigen::Vector3d most;  ///< size of what most of them lie in
  double seconds = 0.0;  ///< that it took to read them
};

/// Points of clouds pass by; those of rasters are kept.
Look lookAt(const io::MapFiles& files, const Globals& globals) {
  Progress progress(globals);
  progress.step("info");
  const Stopwatch watch;
  const auto points = io::streamMap(files, {{}, io::kKeepLittle, progress.ofPasses(), {}});
  Look look;
  look.seconds = watch.seconds();
  look.facts = points->facts();
  const Box3 box = points->box();
  look.low = look.facts.origin + box.min.cast<double>();
  look.high = look.facts.origin + box.max.cast<double>();
  look.most = mostOf(*points);
  return look;
}

void printExtent(const Look& look, const io::FileCrs& crs) {
  const bool metres = !crs.crs || io::isInMetres(*crs.crs);
  const char* const unit = metres ? " m" : "";
  // A thousandth of a degree is a hundred metres.
  const int digits = crs.crs && !io::isProjected(*crs.crs) ? 8 : 3;
  const Eigen::Vector3d& low = look.low;
  const Eigen::Vector3d& high = look.high;
  const Eigen::Vector3d& most = look.most;
  const Eigen::Vector3d size = high - low;
  fmt::print("x          {:.{}f} to {:.{}f}{}\n", low.x(), digits, high.x(), digits, unit);
  fmt::print("y          {:.{}f} to {:.{}f}{}\n", low.y(), digits, high.y(), digits, unit);
  fmt::print("z          {:.3f} to {:.3f}{}\n", low.z(), high.z(), unit);
  fmt::print("extent     {:.{}f} x {:.{}f} x {:.2f}{}\n", size.x(), digits - 1, size.y(),
             digits - 1, size.z(), unit);
  // A few points that fly far off would be taken for the size of the field.
  const bool few_far = most.x() * most.y() < 0.5 * size.x() * size.y();
  if (few_far) {
    fmt::print("most of it {:.{}f} x {:.{}f} x {:.2f}{}: all but 0.2 % of the points\n", most.x(),
               digits - 1, most.y(), digits - 1, most.z(), unit);
  }
  const double area = few_far ? most.x() * most.y() : size.x() * size.y();
  if (area > 0.0 && metres) {
    const double density = static_cast<double>(look.facts.points) / area;
    fmt::print("density    {} points per m2 of the {}\n",
               density < 10.0 ? fmt::format("{:.2g}", density) : fmt::format("{:.0f}", density),
               few_far ? "area of most of it" : "bounding box");
  }
}

ExitCode runInfo(const std::string& path, const Globals& globals) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    printMapInfo(path);
    return ExitCode::kOk;
  }
  const io::MapFiles files = io::mapFilesOf(path);
  const Look look = lookAt(files, globals);
  const io::FileCrs crs = io::crsOfMap(files);
  printWarnings(look.facts.warnings);
  printWarnings(crs.warnings);
  fmt::print("points     {}\n", look.facts.points);
  fmt::print("left out   {} (NaN, infinite, far from the others or withheld)\n",
             look.facts.dropped_points);
  if (!look.facts.fields.empty()) fmt::print("fields     {}\n", look.facts.fields);
  fmt::print("colours    {}\n", look.facts.coloured ? "yes" : "no");
  printCrs(crs);
  printExtent(look, crs);
  fmt::print("offset.xyz {}\n",
             io::readOffsetBeside(files.main) ? "found beside the cloud" : "none");
  for (const std::string& file : io::offsetsPassedBy(files.main)) {
    fmt::print("passed by  {}\n", file);
  }
  fmt::print("read in    {:.3f} s\n", look.seconds);
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addInfoCommand(CLI::App& app, const Globals& globals) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("info", "Say what is in a cloud or a map");
  command
      ->add_option("CLOUD", *path, "LAS, LAZ, PLY, PCD, text, ORTHO.tif,DSM.tif, or a map of fuse")
      ->required();
  return {command, [path, &globals] { return runInfo(*path, globals); }};
}

}  // namespace agricolmap
