#include "agricolmap/io/text/offset_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/text/number_file.hpp"

namespace agricolmap::io {
namespace {

constexpr double kRigidTolerance = 1e-6;

}  // namespace

Eigen::Affine3d readOffset(const std::filesystem::path& path) {
  const auto [n, lines] = readNumbers(path);
  if (!lines.empty() && lines.front() != lines.back()) {
    const auto second = std::find_if(lines.begin(), lines.end(),
                                     [&](std::size_t line) { return line != lines.front(); });
    throw InputError(fmt::format("{}: line {}: an offset is one line 'x y z [roll pitch yaw]'",
                                 path.string(), *second));
  }
  if (n.size() != 3 && n.size() != 6) {
    throw InputError(
        fmt::format("{}: line {}: {} numbers; an offset is 'x y z' or 'x y z roll pitch yaw'",
                    path.string(), lines.empty() ? 1 : lines.front(), n.size()));
  }
  Eigen::Affine3d world_from_cloud(Eigen::Translation3d(n[0], n[1], n[2]));
  if (n.size() == 6) {
    world_from_cloud.rotate(Eigen::AngleAxisd(radians(n[5]), Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(radians(n[4]), Eigen::Vector3d::UnitY()) *
                            Eigen::AngleAxisd(radians(n[3]), Eigen::Vector3d::UnitX()));
  }
  return world_from_cloud;
}

std::optional<Eigen::Affine3d> readOffsetBeside(const std::filesystem::path& cloud_file) {
  const std::filesystem::path folder = cloud_file.parent_path();
  for (const std::string& name :
       {cloud_file.stem().string() + ".offset.xyz", std::string("offset.xyz")}) {
    const std::filesystem::path file = folder / name;
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return readOffset(file);
  }
  return std::nullopt;
}

std::string offsetLine(const Eigen::Affine3d& world_from_cloud) {
  const Eigen::Matrix3d r = world_from_cloud.linear();
  const double skew = (r * r.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(skew < kRigidTolerance) || r.determinant() < 0.0) {
    throw UsageError("an offset file holds a shift and a rotation only; write a matrix instead");
  }
  const double pitch = std::atan2(-r(2, 0), std::hypot(r(0, 0), r(1, 0)));
  // Looking straight up or down, only the sum of roll and yaw counts.
  const bool locked = std::hypot(r(0, 0), r(1, 0)) < kRigidTolerance;
  const double roll = locked ? 0.0 : std::atan2(r(2, 1), r(2, 2));
  const double yaw = locked ? std::atan2(-r(0, 1), r(1, 1)) : std::atan2(r(1, 0), r(0, 0));
  const Eigen::Vector3d t = world_from_cloud.translation();
  std::string text;
  for (const double value : {t.x(), t.y(), t.z(), degrees(roll), degrees(pitch), degrees(yaw)}) {
    if (!text.empty()) text += ' ';
    text += exactText(value + 0.0);  // no minus before zeros
  }
  return text;
}

void writeOffset(const OutputPath& path, const Eigen::Affine3d& world_from_cloud) {
  writeText(path,
            "# x y z [m] roll pitch yaw [deg]: world_from_cloud = T Rz(yaw) Ry(pitch) Rx(roll)\n" +
                offsetLine(world_from_cloud) + "\n");
}

}  // namespace agricolmap::io
