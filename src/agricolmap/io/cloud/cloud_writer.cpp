#include "agricolmap/io/cloud/cloud_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kBlock = 1U << 13;     ///< points one thread encodes at a time
constexpr std::size_t kBlocksPerWrite = 16;  ///< encoded together, then written: about 3.5 MB

std::string plyHeader(const Cloud& cloud) {
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n",
      cloud.size());
  if (cloud.hasColour()) {
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  return header + "end_header\n";
}

std::string pcdHeader(const Cloud& cloud) {
  const bool colour = cloud.hasColour();
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z{}\nSIZE 8 8 8{}\n"
      "TYPE F F F{}\nCOUNT 1 1 1{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\n"
      "DATA binary\n",
      colour ? " rgb" : "", colour ? " 4" : "", colour ? " U" : "", colour ? " 1" : "",
      cloud.size(), cloud.size());
}

/// How a point's colour is stored.
enum class Packing { kRgb, kBgr0 };

void encode(const Cloud& cloud, const PointMove& target_from_file, Packing packing,
            std::size_t begin, std::size_t end, std::byte* out) {
  // The large numbers of both frames cancel once, in double.
  const Eigen::Affine3d target_from_local =
      target_from_file.target_from_file * Eigen::Translation3d(cloud.origin);
  for (std::size_t i = begin; i < end; ++i) {
    Eigen::Vector3d point = target_from_local * cloud.xyz[i].cast<double>();
    if (target_from_file.displacement) point += target_from_file.displacement(cloud.filePoint(i));
    std::memcpy(out, point.data(), sizeof(double) * 3);
    out += sizeof(double) * 3;
    if (!cloud.hasColour()) continue;
    const Rgb& c = cloud.rgb[i];
    if (packing == Packing::kRgb) {
      std::memcpy(out, &c, 3);
      out += 3;
    } else {
      const std::array<std::uint8_t, 4> bytes{c.b, c.g, c.r, 0};
      std::memcpy(out, bytes.data(), bytes.size());
      out += bytes.size();
    }
  }
}

void writePoints(const OutputPath& path, const std::string& header, Packing packing,
                 const Cloud& cloud, const PointMove& target_from_file) {
  static_assert(sizeof(Rgb) == 3);
  const std::size_t colour_bytes = packing == Packing::kRgb ? 3 : 4;
  const std::size_t point_bytes = 3 * sizeof(double) + (cloud.hasColour() ? colour_bytes : 0);
  FileSink sink(path);
  sink.write(header);
  constexpr std::size_t kPerWrite = kBlock * kBlocksPerWrite;
  std::vector<std::byte> buffer(point_bytes * std::min(kPerWrite, cloud.size()));
  for (std::size_t begin = 0; begin < cloud.size(); begin += kPerWrite) {
    const std::size_t end = std::min(cloud.size(), begin + kPerWrite);
    parallelFor((end - begin + kBlock - 1) / kBlock, [&](std::size_t block) {
      const std::size_t first = begin + block * kBlock;
      const std::size_t last = std::min(end, first + kBlock);
      encode(cloud, target_from_file, packing, first, last,
             buffer.data() + (first - begin) * point_bytes);
    });
    sink.write(std::span<const std::byte>(buffer).first((end - begin) * point_bytes));
  }
  sink.close();
}

}  // namespace

void writePly(const OutputPath& path, const Cloud& cloud) { writePly(path, cloud, PointMove()); }

void writePly(const OutputPath& path, const Cloud& cloud, const PointMove& target_from_file) {
  writePoints(path, plyHeader(cloud), Packing::kRgb, cloud, target_from_file);
}

void writePcd(const OutputPath& path, const Cloud& cloud, const PointMove& target_from_file) {
  writePoints(path, pcdHeader(cloud), Packing::kBgr0, cloud, target_from_file);
}

void writeCloud(const OutputPath& path, const Cloud& cloud, CloudFormat format,
                const PointMove& target_from_file) {
  switch (format) {
    case CloudFormat::kPly:
      return writePly(path, cloud, target_from_file);
    case CloudFormat::kPcd:
      return writePcd(path, cloud, target_from_file);
    case CloudFormat::kXyz:
      throw UsageError(fmt::format("{}: lines of text are read, never written", path.shown()));
    case CloudFormat::kLas:
    case CloudFormat::kLaz:
    case CloudFormat::kCopc:
      break;
  }
  writeLas(path, cloud, format, target_from_file);
}

}  // namespace agricolmap::io
