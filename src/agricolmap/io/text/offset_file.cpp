#include "agricolmap/io/text/offset_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "agricolmap/core/angles.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/number_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr double kRigidTolerance = 1e-6;
constexpr int kMostLooked = 10000;  // files of a folder

/// Where OpenDroneMap's local coordinates have their zero: the second line, behind one that names
/// the UTM zone. Nothing for other files.
std::optional<Eigen::Affine3d> odmOffset(const std::filesystem::path& path) {
  const MappedFile file(path);
  std::string_view rest = withoutMark(file.text());
  const char line_end = lineEndOf(rest);
  if (!takeLine(rest, line_end).starts_with("WGS84 UTM ")) return std::nullopt;
  const std::vector<std::string_view> words = splitWords(takeLine(rest, line_end));
  const auto east = words.size() == 2 ? parseNumber(words[0]) : std::nullopt;
  const auto north = words.size() == 2 ? parseNumber(words[1]) : std::nullopt;
  if (!east || !north || !std::isfinite(*east + *north)) {
    throw InputError(fmt::format("{}: line 2: behind the UTM zone 'x y' are expected, the offset",
                                 path.string()));
  }
  return Eigen::Affine3d(Eigen::Translation3d(*east, *north, 0.0));
}

std::array<std::string, 2> namesThatCount(const std::filesystem::path& cloud_file) {
  return {cloud_file.stem().string() + ".offset.xyz", "offset.xyz"};
}

/// Whether a cloud lies beside `offset` whose offset it is by its name.
bool belongsToAnother(const std::filesystem::path& offset, const std::filesystem::path& folder) {
  constexpr std::string_view kEnding = ".offset.xyz";
  const std::string name = offset.filename().string();
  if (name.size() <= kEnding.size() || !name.ends_with(kEnding)) return false;
  const std::string stem = name.substr(0, name.size() - kEnding.size());
  std::error_code error;
  std::filesystem::directory_iterator entry(folder, error);
  for (int i = 0; i < kMostLooked && !error && entry != std::filesystem::directory_iterator();
       ++i) {
    const std::filesystem::path& other = entry->path();
    if (other.filename() != name && other.stem() == stem) return true;
    entry.increment(error);
  }
  return false;
}

bool mayBeOffset(const std::string& file_name) {
  const std::string name = lowerCase(file_name);
  return name.ends_with("offset.xyz") || name == "offset.txt" || name == "coords.txt" ||
         name == "odm_georeferencing_model_geo.txt";
}

}  // namespace

Eigen::Affine3d readOffset(const std::filesystem::path& path) {
  if (const auto offset = odmOffset(path)) return *offset;
  const NumberFile file = readNumbers(path);
  const std::vector<double>& n = file.numbers;
  const std::vector<std::size_t>& lines = file.lines;
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
  for (const std::string& name : namesThatCount(cloud_file)) {
    const std::filesystem::path file = folder / name;
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) return readOffset(file);
  }
  return std::nullopt;
}

std::vector<std::string> offsetsPassedBy(const std::filesystem::path& cloud_file) {
  const std::filesystem::path folder =
      cloud_file.has_parent_path() ? cloud_file.parent_path() : std::filesystem::path(".");
  std::error_code error;
  for (const std::string& name : namesThatCount(cloud_file)) {
    if (std::filesystem::exists(folder / name, error)) return {};
  }
  std::vector<std::string> passed;
  std::filesystem::directory_iterator entry(folder, error);
  for (int i = 0; i < kMostLooked && !error && entry != std::filesystem::directory_iterator();
       ++i) {
    const std::filesystem::path file = entry->path();
    if (mayBeOffset(file.filename().string()) && file.filename() != cloud_file.filename() &&
        !belongsToAnother(file, folder)) {
      passed.push_back(cloud_file.has_parent_path() ? file.string() : file.filename().string());
    }
    entry.increment(error);
  }
  std::sort(passed.begin(), passed.end());
  return passed;
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
