// agricolmap info CLOUD, or of a shared map
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "agricolmap/core/robust.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "common.hpp"
#include "map_info.hpp"

namespace agricolmap {
namespace {

bool isMetric(const io::FileCrs& file) {
  return !file.crs || (io::isProjected(*file.crs) && file.crs->horizontal_unit == 1.0 &&
                       file.crs->vertical_unit == 1.0);
}

void printCrs(const io::FileCrs& file) {
  if (!file.crs) {
    fmt::print("system     not said; taken as metres\n");
    return;
  }
  fmt::print("system     {}", file.crs->name);
  if (!io::isProjected(*file.crs)) {
    fmt::print(" (no metres)");
  } else if (!isMetric(file)) {
    fmt::print(" (units of {:.10g} m, heights of {:.10g} m)", file.crs->horizontal_unit,
               file.crs->vertical_unit);
  }
  fmt::print("\n");
}

/// Size of what all but one point in 500 lie in, along each axis [m].
Eigen::Vector3d mostOf(const Cloud& cloud) {
  constexpr std::size_t kTail = 1000;
  Eigen::Vector3d size;
  std::vector<float> values(cloud.size());
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::transform(cloud.xyz.begin(), cloud.xyz.end(), values.begin(),
                   [&](const Eigen::Vector3f& point) { return point[axis]; });
    const std::size_t low = values.size() / kTail;
    size[axis] = static_cast<double>(valueAtRank(values, values.size() - 1 - low)) -
                 static_cast<double>(valueAtRank(values, low));
  }
  return size;
}

ExitCode runInfo(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    printMapInfo(path);
    return ExitCode::kOk;
  }
  const Stopwatch watch;
  const io::MapFiles files = io::mapFilesOf(path);
  const Cloud cloud = io::readMap(files);
  const double seconds = watch.seconds();
  const io::FileCrs crs = io::crsOfMap(files);
  printWarnings(cloud.warnings);
  printWarnings(crs.warnings);
  const Box3 box = boundingBox(cloud);
  const Eigen::Vector3d low = cloud.origin + box.min.cast<double>();
  const Eigen::Vector3d high = cloud.origin + box.max.cast<double>();
  const Eigen::Vector3d size = high - low;
  fmt::print("points     {}\n", cloud.size());
  fmt::print("left out   {} (NaN, infinite, far from the others or withheld)\n",
             cloud.dropped_points);
  if (!cloud.fields.empty()) fmt::print("fields     {}\n", cloud.fields);
  fmt::print("colours    {}\n", cloud.hasColour() ? "yes" : "no");
  printCrs(crs);
  const bool metres = isMetric(crs);
  const char* const unit = metres ? " m" : "";
  // A thousandth of a degree is a hundred metres.
  const int digits = crs.crs && !io::isProjected(*crs.crs) ? 8 : 3;
  fmt::print("x          {:.{}f} to {:.{}f}{}\n", low.x(), digits, high.x(), digits, unit);
  fmt::print("y          {:.{}f} to {:.{}f}{}\n", low.y(), digits, high.y(), digits, unit);
  fmt::print("z          {:.3f} to {:.3f}{}\n", low.z(), high.z(), unit);
  fmt::print("extent     {:.{}f} x {:.{}f} x {:.2f}{}\n", size.x(), digits - 1, size.y(),
             digits - 1, size.z(), unit);
  // A few points that fly far off would be taken for the size of the field.
  const Eigen::Vector3d most = mostOf(cloud);
  const bool few_far = most.x() * most.y() < 0.5 * size.x() * size.y();
  if (few_far) {
    fmt::print("most of it {:.{}f} x {:.{}f} x {:.2f}{}: all but 0.2 % of the points\n", most.x(),
               digits - 1, most.y(), digits - 1, most.z(), unit);
  }
  const double area = few_far ? most.x() * most.y() : size.x() * size.y();
  if (area > 0.0 && metres) {
    const double density = static_cast<double>(cloud.size()) / area;
    fmt::print("density    {} points per m2 of the {}\n",
               density < 10.0 ? fmt::format("{:.2g}", density) : fmt::format("{:.0f}", density),
               few_far ? "area of most of it" : "bounding box");
  }
  fmt::print("offset.xyz {}\n",
             io::readOffsetBeside(files.main) ? "found beside the cloud" : "none");
  for (const std::string& file : io::offsetsPassedBy(files.main)) {
    fmt::print("passed by  {}\n", file);
  }
  fmt::print("read in    {:.3f} s\n", seconds);
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addInfoCommand(CLI::App& app, const Globals&) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("info", "Say what is in a cloud or a map");
  command
      ->add_option("CLOUD", *path, "LAS, LAZ, PLY, PCD, text, ORTHO.tif,DSM.tif, or a map of fuse")
      ->required();
  return {command, [path] { return runInfo(*path); }};
}

}  // namespace agricolmap
