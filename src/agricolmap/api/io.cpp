#include "agricolmap/io.hpp"

#include <fmt/format.h>

#include <array>
#include <memory>
#include <optional>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/cloud/point_source.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/offset_file.hpp"
#include "agricolmap/io/text/path_file.hpp"

namespace agricolmap {

Cloud readCloud(const std::filesystem::path& path) {
  requireProcessor();
  return io::readCloud(path);
}

Cloud makeCloud(std::span<const Eigen::Vector3d> points, std::span<const Rgb> colours,
                const std::string& name) {
  requireProcessor();
  if (!colours.empty() && colours.size() != points.size()) {
    throw UsageError(fmt::format("{}: {} colours for {} points; give one each, or none", name,
                                 colours.size(), points.size()));
  }
  io::BinaryColumns columns;
  columns.points = points.size();
  const std::byte* const xyz = std::as_bytes(points).data();
  for (std::size_t i = 0; i < 3; ++i) {
    columns.xyz[i] = {xyz + i * sizeof(double), sizeof(Eigen::Vector3d), io::ScalarType::kFloat64};
  }
  if (!colours.empty()) {
    const std::byte* const rgb = std::as_bytes(colours).data();
    columns.colour.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
      (*columns.colour)[i] = {rgb + i, sizeof(Rgb), io::ScalarType::kUint8};
    }
  }
  io::PointFile file;
  file.name = name;
  file.source = std::make_unique<io::BinarySource>(columns);
  return io::assembleCloud(file);
}

void writePly(const std::filesystem::path& path, const Cloud& cloud) { io::writePly(path, cloud); }

void writePly(const std::filesystem::path& path, const Cloud& cloud,
              const Transform& target_from_file) {
  io::writePly(path, cloud, Eigen::Affine3d(target_from_file));
}

void writeCloud(const std::filesystem::path& path, const Cloud& cloud,
                const Transform& target_from_file) {
  const std::optional<io::CloudFormat> format = io::formatByEnding(path);
  if (!format) {
    throw UsageError(fmt::format(
        "{}: its ending names no format that is written; they are ply, pcd, las, laz and copc.laz",
        path.string()));
  }
  io::writeCloud(path, cloud, *format, Eigen::Affine3d(target_from_file));
}

Transform readMatrix(const std::filesystem::path& path) { return io::readMatrix(path); }

void writeMatrix(const std::filesystem::path& path, const Transform& target_from_source) {
  io::writeMatrix(path, Eigen::Affine3d(target_from_source));
}

std::vector<Eigen::Vector3d> readPath(const std::filesystem::path& path) {
  return io::readPath(path);
}

std::optional<Transform> readOffsetBeside(const std::filesystem::path& cloud) {
  return io::readOffsetBeside(cloud);
}

}  // namespace agricolmap
