#include "agricolmap/io/las/las_copy.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/point_source.hpp"
#include "agricolmap/io/las/las_points.hpp"
#include "agricolmap/io/las/las_writer.hpp"
#include "agricolmap/io/text/mapped_file.hpp"

namespace agricolmap::io {
namespace {

/// Chunks that are decoded side by side before they are written.
constexpr std::size_t kTogether = 8;
constexpr std::size_t kBlock = 512;

/// Steps that are fit for metres, or one that is.
Eigen::Vector3d fitSteps(const Eigen::Vector3d& steps, const LasMove& move) {
  constexpr double kFinest = 1e-5;
  constexpr double kCoarsest = 0.01;
  constexpr double kMillimetre = 0.001;
  if (move.map != nullptr) return Eigen::Vector3d::Constant(kMillimetre);
  return steps.unaryExpr([&](double step) {
    const double size = std::abs(step);
    return size >= kFinest && size <= kCoarsest ? size : kMillimetre;
  });
}

LasOutline movedOutline(LasOutline outline, const LasMove& move) {
  outline.scale = fitSteps(outline.scale, move);
  outline.offset = move.target_from_file(move.origin).array().round().matrix();
  if (!move.crs.wkt.empty()) outline.setCrs(move.crs.wkt);
  return outline;
}

/// Moves records in place and closes the gaps of those that have no place; how many are left.
std::size_t moveRecords(const LasHeader& header, const LasMove& move, const LasOutline& outline,
                        std::vector<std::byte>& records) {
  const std::size_t length = header.layout.length;
  const std::size_t count = records.size() / length;
  std::array<std::array<double, kBlock>, 3> xyz;
  std::size_t kept = 0;
  for (std::size_t begin = 0; begin < count; begin += kBlock) {
    const std::size_t block = std::min(kBlock, count - begin);
    for (std::size_t i = 0; i < block; ++i) {
      const Eigen::Vector3d point = header.pointOf(&records[(begin + i) * length]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        xyz[axis][i] = point[static_cast<Eigen::Index>(axis)];
      }
    }
    if (move.map != nullptr) move.map->apply(xyz[0].data(), xyz[1].data(), xyz[2].data(), block);
    for (std::size_t i = 0; i < block; ++i) {
      const Eigen::Vector3d point(xyz[0][i], xyz[1][i], xyz[2][i]);
      std::byte* const from = &records[(begin + i) * length];
      const bool near = (point - move.origin).cwiseAbs().maxCoeff() <= kMaxFromOrigin;
      if (!near || !outline.store(move.target_from_file(point), from)) continue;
      std::byte* const to = &records[kept * length];
      if (to != from) std::copy_n(from, length, to);
      ++kept;
    }
  }
  return kept;
}

}  // namespace

LasCopied copyLas(const std::filesystem::path& from, const OutputPath& to, bool compressed,
                  const std::optional<LasMove>& move) {
  const MappedFile file(from);
  const LasHeader header = parseLasHeader(file.bytes(), from.string());
  const auto points = lasPoints(file.bytes(), header, from.string());
  LasOutline outline = lasOutline(file.bytes(), header);
  if (move) outline = movedOutline(std::move(outline), *move);
  LasCopied copied;
  if (header.layout.wave) {
    copied.warnings.push_back(fmt::format(
        "{}: its points refer to wave packets, which are not taken along", from.string()));
  }

  LasWriter writer(to, outline, compressed);
  const std::size_t length = header.layout.length;
  std::array<std::vector<std::byte>, kTogether> parts;
  for (std::size_t begin = 0; begin < points->chunks(); begin += kTogether) {
    const std::size_t count = std::min(kTogether, points->chunks() - begin);
    parallelFor(count, [&](std::size_t i) {
      std::vector<std::byte>& records = parts[i];
      records.clear();
      points->decode(begin + i, LasWanted::kAll, [&](const std::byte* first, std::size_t n) {
        records.insert(records.end(), first, first + n * length);
      });
      if (move) records.resize(moveRecords(header, *move, outline, records) * length);
    });
    for (std::size_t i = 0; i < count; ++i) {
      throwIfInterrupted();
      writer.write(parts[i].data(), parts[i].size() / length);
    }
  }
  writer.close();
  copied.points = writer.points();
  copied.left_out = header.points - writer.points();
  return copied;
}

void writeLas(const OutputPath& path, const Cloud& cloud, bool compressed,
              const PointMove& target_from_file) {
  LasOutline outline = lasOutline(cloud.hasColour());
  outline.offset = target_from_file(cloud.origin).array().round().matrix();
  if (!cloud.crs.wkt.empty()) outline.setCrs(cloud.crs.wkt);
  const std::size_t length = outline.layout.length;
  LasWriter writer(path, outline, compressed);
  constexpr std::size_t kPoints = std::size_t{1} << 16;
  std::vector<std::byte> records;
  for (std::size_t begin = 0; begin < cloud.size(); begin += kPoints) {
    throwIfInterrupted();
    const std::size_t count = std::min(kPoints, cloud.size() - begin);
    records.assign(count * length, std::byte{0});
    parallelFor(
        count,
        [&](std::size_t i) {
          std::byte* const record = &records[i * length];
          if (!outline.store(target_from_file(cloud.filePoint(begin + i)), record)) {
            throw UsageError(path.shown() +
                             ": its points are more than 2000 km apart, too far for LAS");
          }
          storeLe(record + 14, std::uint8_t{0x11});  // the first of one return
          if (!cloud.hasColour()) return;
          const Rgb colour = cloud.rgb[begin + i];
          constexpr std::uint16_t kWide = 257;
          storeLe(record + *outline.layout.rgb, static_cast<std::uint16_t>(kWide * colour.r));
          storeLe(record + *outline.layout.rgb + 2, static_cast<std::uint16_t>(kWide * colour.g));
          storeLe(record + *outline.layout.rgb + 4, static_cast<std::uint16_t>(kWide * colour.b));
        },
        4096);
    writer.write(records.data(), count);
  }
  writer.close();
}

}  // namespace agricolmap::io
