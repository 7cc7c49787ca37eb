#include "agricolmap/io/cloud/cloud_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {
namespace {

constexpr double kMaxFloatCoordinate = 1e4;
constexpr std::size_t kBlock = 1U << 13;     ///< points one thread encodes at a time
constexpr std::size_t kBlocksPerWrite = 16;  ///< encoded together, then written: about 3.5 MB

std::string headerOf(const Cloud& cloud, bool floats, bool colours,
                     const std::vector<std::string>& comments) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) {
    if (comment.find('\n') != std::string::npos) {
      throw UsageError("a comment of a PLY file must be one line");
    }
    header += fmt::format("comment {}\n", comment);
  }
  header += fmt::format("element vertex {}\n", cloud.size());
  for (const char axis : {'x', 'y', 'z'}) {
    header += fmt::format("property {} {}\n", floats ? "float" : "double", axis);
  }
  if (colours) header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  return header + "end_header\n";
}

template <typename Scalar>
void encode(const Cloud& cloud, const Eigen::Affine3d& target_from_local, std::size_t begin,
            std::size_t end, bool colours, std::byte* out) {
  const Eigen::Matrix3d linear = target_from_local.linear();
  const Eigen::Vector3d shift = target_from_local.translation();
  for (std::size_t i = begin; i < end; ++i) {
    const Eigen::Matrix<Scalar, 3, 1> point =
        (linear * cloud.xyz[i].cast<double>() + shift).cast<Scalar>();
    std::memcpy(out, point.data(), sizeof(Scalar) * 3);
    out += sizeof(Scalar) * 3;
    if (!colours) continue;
    std::memcpy(out, &cloud.rgb[i], 3);
    out += 3;
  }
}

void refuseCoarseFloats(const OutputPath& path, const Cloud& cloud,
                        const Eigen::Affine3d& target_from_local) {
  if (cloud.empty()) return;
  const Box3 box = boundingBox(cloud);
  const Eigen::AlignedBox3d local(box.min.cast<double>(), box.max.cast<double>());
  const Eigen::AlignedBox3d target = local.transformed(target_from_local);
  const double far =
      std::max(target.min().cwiseAbs().maxCoeff(), target.max().cwiseAbs().maxCoeff());
  if (far > kMaxFloatCoordinate) {
    throw UsageError(fmt::format(
        "{}: coordinates up to {:.0f} m would lose precision as 32-bit floats; write doubles",
        path.shown(), far));
  }
}

}  // namespace

void writePly(const OutputPath& path, const Cloud& cloud, const PlyWriteOptions& options) {
  writePly(path, cloud, Eigen::Affine3d::Identity(), options);
}

void writePly(const OutputPath& path, const Cloud& cloud, const Eigen::Affine3d& target_from_file,
              const PlyWriteOptions& options) {
  static_assert(sizeof(Rgb) == 3);
  const Eigen::Affine3d target_from_local = target_from_file * Eigen::Translation3d(cloud.origin);
  const bool floats = options.float_coordinates;
  const bool colours = options.colours && cloud.hasColour();
  if (floats) refuseCoarseFloats(path, cloud, target_from_local);
  const std::size_t point_bytes = 3 * (floats ? sizeof(float) : sizeof(double)) + (colours ? 3 : 0);

  FileSink sink(path);
  sink.write(headerOf(cloud, floats, colours, options.comments));
  constexpr std::size_t kPerWrite = kBlock * kBlocksPerWrite;
  std::vector<std::byte> buffer(point_bytes * std::min(kPerWrite, cloud.size()));
  for (std::size_t begin = 0; begin < cloud.size(); begin += kPerWrite) {
    const std::size_t end = std::min(cloud.size(), begin + kPerWrite);
    parallelFor((end - begin + kBlock - 1) / kBlock, [&](std::size_t block) {
      const std::size_t first = begin + block * kBlock;
      const std::size_t last = std::min(end, first + kBlock);
      std::byte* const out = buffer.data() + (first - begin) * point_bytes;
      if (floats) {
        encode<float>(cloud, target_from_local, first, last, colours, out);
      } else {
        encode<double>(cloud, target_from_local, first, last, colours, out);
      }
    });
    sink.write(std::span<const std::byte>(buffer).first((end - begin) * point_bytes));
  }
  sink.close();
}

}  // namespace agricolmap::io
