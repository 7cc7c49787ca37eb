#include "agricolmap/io/cloud/cloud_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kBlock = 1U << 13;     ///< points one thread encodes at a time
constexpr std::size_t kBlocksPerWrite = 16;  ///< encoded together, then written: about 3.5 MB

std::string headerOf(const Cloud& cloud) {
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n",
      cloud.size());
  if (cloud.hasColour()) {
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  return header + "end_header\n";
}

void encode(const Cloud& cloud, const Eigen::Affine3d& target_from_local, std::size_t begin,
            std::size_t end, std::byte* out) {
  const Eigen::Matrix3d linear = target_from_local.linear();
  const Eigen::Vector3d shift = target_from_local.translation();
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Vector3d point = linear * cloud.xyz[i].cast<double>() + shift;
    std::memcpy(out, point.data(), sizeof(double) * 3);
    out += sizeof(double) * 3;
    if (!cloud.hasColour()) continue;
    std::memcpy(out, &cloud.rgb[i], 3);
    out += 3;
  }
}

}  // namespace

void writePly(const OutputPath& path, const Cloud& cloud) {
  writePly(path, cloud, Eigen::Affine3d::Identity());
}

void writePly(const OutputPath& path, const Cloud& cloud, const Eigen::Affine3d& target_from_file) {
  static_assert(sizeof(Rgb) == 3);
  const Eigen::Affine3d target_from_local = target_from_file * Eigen::Translation3d(cloud.origin);
  const std::size_t point_bytes = 3 * sizeof(double) + (cloud.hasColour() ? 3 : 0);

  FileSink sink(path);
  sink.write(headerOf(cloud));
  constexpr std::size_t kPerWrite = kBlock * kBlocksPerWrite;
  std::vector<std::byte> buffer(point_bytes * std::min(kPerWrite, cloud.size()));
  for (std::size_t begin = 0; begin < cloud.size(); begin += kPerWrite) {
    const std::size_t end = std::min(cloud.size(), begin + kPerWrite);
    parallelFor((end - begin + kBlock - 1) / kBlock, [&](std::size_t block) {
      const std::size_t first = begin + block * kBlock;
      const std::size_t last = std::min(end, first + kBlock);
      encode(cloud, target_from_local, first, last, buffer.data() + (first - begin) * point_bytes);
    });
    sink.write(std::span<const std::byte>(buffer).first((end - begin) * point_bytes));
  }
  sink.close();
}

}  // namespace agricolmap::io
