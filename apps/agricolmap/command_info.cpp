// agricolmap info CLOUD
#include <fmt/format.h>

#include <memory>

#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

ExitCode runInfo(const std::string& path) {
  const Stopwatch watch;
  const Cloud cloud = io::readCloud(path);
  const double seconds = watch.seconds();
  printWarnings(cloud.warnings);
  const Box3 box = boundingBox(cloud);
  const Eigen::Vector3d low = cloud.origin + box.min.cast<double>();
  const Eigen::Vector3d high = cloud.origin + box.max.cast<double>();
  const Eigen::Vector3d size = high - low;
  fmt::print("points     {}\n", cloud.size());
  fmt::print("left out   {} (NaN, infinite or far from the others)\n", cloud.dropped_points);
  fmt::print("colours    {}\n", cloud.hasColour() ? "yes" : "no");
  fmt::print("x          {:.3f} to {:.3f} m\n", low.x(), high.x());
  fmt::print("y          {:.3f} to {:.3f} m\n", low.y(), high.y());
  fmt::print("z          {:.3f} to {:.3f} m\n", low.z(), high.z());
  fmt::print("extent     {:.2f} x {:.2f} x {:.2f} m\n", size.x(), size.y(), size.z());
  const double area = size.x() * size.y();
  if (area > 0.0) {
    fmt::print("density    {:.0f} points per m2 of the bounding box\n",
               static_cast<double>(cloud.size()) / area);
  }
  fmt::print("offset.xyz {}\n", io::readOffsetBeside(path) ? "found beside the cloud" : "none");
  fmt::print("read in    {:.3f} s\n", seconds);
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addInfoCommand(CLI::App& app, const Globals&) {
  auto path = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("info", "Say what is in a cloud");
  command->add_option("CLOUD", *path, "PLY or PCD")->required();
  return {command, [path] { return runInfo(*path); }};
}

}  // namespace agricolmap
