#include "agricolmap/io/cloud/cloud_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kBlock = 1U << 13;     ///< points one thread encodes at a time
constexpr std::size_t kBlocksPerWrite = 16;  ///< encoded together, then written: about 3.5 MB

std::string plyHeader(const CloudFacts& facts) {
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\n"
      "property double x\nproperty double y\nproperty double z\n",
      facts.points);
  if (facts.coloured) {
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  return header + "end_header\n";
}

std::string pcdHeader(const CloudFacts& facts) {
  const bool colour = facts.coloured;
  return fmt::format(
      "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z{}\nSIZE 8 8 8{}\n"
      "TYPE F F F{}\nCOUNT 1 1 1{}\nWIDTH {}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {}\n"
      "DATA binary\n",
      colour ? " rgb" : "", colour ? " 4" : "", colour ? " U" : "", colour ? " 1" : "",
      facts.points, facts.points);
}

/// How a point's colour is stored.
enum class Packing { kRgb, kBgr0 };

/// Makes records of points.
class Encoder {
 public:
  Encoder(const CloudFacts& facts, const PointMove& target_from_file, Packing packing)
      : origin_(facts.origin),
        move_(target_from_file),
        // The large numbers of both frames cancel once, in double.
        target_from_local_(target_from_file.target_from_file * Eigen::Translation3d(facts.origin)),
        coloured_(facts.coloured),
        packing_(packing) {}

  std::size_t pointBytes() const {
    const std::size_t colour_bytes = packing_ == Packing::kRgb ? 3 : 4;
    return 3 * sizeof(double) + (coloured_ ? colour_bytes : 0);
  }

  void encode(const PointBatch& batch, std::size_t begin, std::size_t end, std::byte* out) const {
    static_assert(sizeof(Rgb) == 3);
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3d local = batch.xyz[i].cast<double>();
      Eigen::Vector3d point = target_from_local_ * local;
      if (move_.displacement) point += move_.displacement(origin_ + local);
      std::memcpy(out, point.data(), sizeof(double) * 3);
      out += sizeof(double) * 3;
      if (!coloured_) continue;
      const Rgb& c = batch.rgb[i];
      if (packing_ == Packing::kRgb) {
        std::memcpy(out, &c, 3);
        out += 3;
      } else {
        const std::array<std::uint8_t, 4> bytes{c.b, c.g, c.r, 0};
        std::memcpy(out, bytes.data(), bytes.size());
        out += bytes.size();
      }
    }
  }

 private:
  Eigen::Vector3d origin_;
  const PointMove& move_;
  Eigen::Affine3d target_from_local_;
  bool coloured_;
  Packing packing_;
};

void writePoints(const OutputPath& path, const std::string& header, const PointStream& points,
                 const Encoder& encoder) {
  FileSink sink(path);
  sink.write(header);
  constexpr std::size_t kPerWrite = kBlock * kBlocksPerWrite;
  const std::size_t point_bytes = encoder.pointBytes();
  std::vector<std::byte> buffer(point_bytes * std::min(kPerWrite, points.facts().points));
  points.pass([&](const PointBatch& batch) {
    for (std::size_t begin = 0; begin < batch.size(); begin += kPerWrite) {
      const std::size_t end = std::min(batch.size(), begin + kPerWrite);
      parallelFor((end - begin + kBlock - 1) / kBlock, [&](std::size_t block) {
        const std::size_t first = begin + block * kBlock;
        encoder.encode(batch, first, std::min(end, first + kBlock),
                       buffer.data() + (first - begin) * point_bytes);
      });
      sink.write(std::span<const std::byte>(buffer).first((end - begin) * point_bytes));
    }
  });
  sink.close();
}

}  // namespace

void writeCloud(const OutputPath& path, const PointStream& points, CloudFormat format,
                const PointMove& target_from_file) {
  const CloudFacts& facts = points.facts();
  switch (format) {
    case CloudFormat::kPly:
      return writePoints(path, plyHeader(facts), points, {facts, target_from_file, Packing::kRgb});
    case CloudFormat::kPcd:
      return writePoints(path, pcdHeader(facts), points, {facts, target_from_file, Packing::kBgr0});
    case CloudFormat::kXyz:
      throw UsageError(fmt::format("{}: lines of text are read, never written", path.shown()));
    case CloudFormat::kLas:
    case CloudFormat::kLaz:
    case CloudFormat::kCopc:
      break;
  }
  writeLas(path, points, format, target_from_file);
}

void writeCloud(const OutputPath& path, const Cloud& cloud, CloudFormat format,
                const PointMove& target_from_file) {
  writeCloud(path, CloudStream(cloud), format, target_from_file);
}

void writePly(const OutputPath& path, const Cloud& cloud, const PointMove& target_from_file) {
  writeCloud(path, cloud, CloudFormat::kPly, target_from_file);
}

}  // namespace agricolmap::io
