#include "agricolmap/fuse/cloud_file.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/fuse/point_rule.hpp"
#include "agricolmap/io/las/las_copy.hpp"
#include "agricolmap/io/las/las_marks.hpp"
#include "agricolmap/io/las/las_writer.hpp"

namespace agricolmap::fuse {
namespace {

/// Extra bytes of a point, LAS 1.4 R15 table 24.
struct ExtraField {
  std::string_view name;
  std::string_view description;
  std::uint8_t type;  ///< 5: 32-bit unsigned, 9: 32-bit float
};
constexpr std::array<ExtraField, 4> kFields{{{"date", "YYYYMMDD, 0: unknown", 5},
                                             {"plane_error", "expected RMS, m", 9},
                                             {"height_error", "expected RMS, m", 9},
                                             {"raised", "change of z by fusing, m", 9}}};
constexpr std::size_t kFieldBytes = 4;

io::LasOwnRecord extraRecord() {
  constexpr std::size_t kDescriptor = 192, kType = 2, kName = 4, kDescription = 160;
  constexpr std::uint16_t kExtraBytes = 4;
  io::LasOwnRecord record{"LASF_Spec", kExtraBytes, "source of each point", {}, false};
  record.data.assign(kFields.size() * kDescriptor, std::byte{0});
  for (std::size_t i = 0; i < kFields.size(); ++i) {
    std::byte* const at = &record.data[i * kDescriptor];
    at[kType] = std::byte{kFields[i].type};
    std::memcpy(at + kName, kFields[i].name.data(), kFields[i].name.size());
    std::memcpy(at + kDescription, kFields[i].description.data(), kFields[i].description.size());
  }
  return record;
}

io::LasOutline outlineOf(const SharedMap& map, const Crs& crs) {
  io::LasOutline outline = io::lasOutline(true);
  outline.offset = map.layers.origin;
  outline.layout.length += kFields.size() * kFieldBytes;
  outline.records.push_back(extraRecord());
  if (!crs.wkt.empty()) outline.setCrs(crs.wkt);
  return outline;
}

/// Of all points of a source.
struct SourceOfPoints {
  std::uint16_t code = kNoSource;
  std::int32_t date = 0;
};

bool store(const FusedPoint& point, const io::PointMarks& marks, const SourceOfPoints& source,
           const io::LasOutline& outline, std::byte* record) {
  constexpr std::size_t kSourceId = 20;
  constexpr std::uint16_t kWide = 257;
  if (!outline.store(outline.offset + point.place.cast<double>(), record)) return false;
  io::storeMarks(marks, record);
  io::storeLe(record + kSourceId, source.code);
  std::byte* const rgb = record + *outline.layout.rgb;
  io::storeLe(rgb, static_cast<std::uint16_t>(kWide * point.colour.r));
  io::storeLe(rgb + 2, static_cast<std::uint16_t>(kWide * point.colour.g));
  io::storeLe(rgb + 4, static_cast<std::uint16_t>(kWide * point.colour.b));
  std::byte* const extra = record + outline.layout.base;
  io::storeLe(extra, static_cast<std::uint32_t>(source.date));
  io::storeLe(extra + kFieldBytes, point.plane_error);
  io::storeLe(extra + 2 * kFieldBytes, point.height_error);
  io::storeLe(extra + 3 * kFieldBytes, point.raised);
  return true;
}

/// Writes what `rule(place, colour)` keeps of a cloud, in its order.
template <typename Rule>
std::uint64_t append(const PointStream& cloud, const Eigen::Vector3d& origin,
                     const SourceOfPoints& source, const Rule& rule, io::LasWriter& writer) {
  constexpr std::size_t kChunk = std::size_t{1} << 14;
  const io::LasOutline& outline = writer.outline();
  const Eigen::Vector3f shift = (cloud.facts().origin - origin).cast<float>();
  const std::size_t length = outline.layout.length;
  std::vector<std::vector<std::byte>> chunks;
  std::uint64_t kept = 0;
  io::passMarked(cloud, [&](const PointBatch& batch, std::span<const io::PointMarks> marks) {
    chunks.resize((batch.size() + kChunk - 1) / kChunk);
    parallelFor(chunks.size(), [&](std::size_t chunk) {
      std::vector<std::byte>& records = chunks[chunk];
      records.clear();
      const std::size_t end = std::min(batch.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < end; ++i) {
        const std::optional<FusedPoint> point =
            rule(batch.xyz[i] + shift, batch.rgb.empty() ? Rgb{} : batch.rgb[i]);
        if (!point) continue;
        records.resize(records.size() + length);
        if (!store(*point, marks.empty() ? io::PointMarks{} : marks[i], source, outline,
                   &records[records.size() - length])) {
          throw UsageError("points are more than 2000 km apart, too far for LAS");
        }
      }
    });
    for (const std::vector<std::byte>& records : chunks) {
      writer.write(records.data(), records.size() / length);
      kept += records.size() / length;
    }
  });
  return kept;
}

PointCounts writeRecords(io::LasWriter& writer, const SharedMap& map, const PointStream& fixed,
                         std::int32_t fixed_date, const std::vector<StripInput>& strips,
                         const FuseOptions& options) {
  const PointRule rule(map, options);
  PointCounts counts;
  counts.push_back(append(
      fixed, map.layers.origin, {kFixedSource, fixed_date},
      [&](const Eigen::Vector3f& place, Rgb colour) { return rule.ofFixed(place, colour); },
      writer));
  for (std::size_t i = 0; i < map.strips.size(); ++i) {
    const FusedStrip& strip = map.strips[i];
    const auto input = std::find_if(strips.begin(), strips.end(),
                                    [&](const StripInput& other) { return other.id == strip.id; });
    counts.push_back(append(
        *input->points, map.layers.origin, {strip.code, strip.date},
        [&](const Eigen::Vector3f& place, Rgb colour) { return rule.ofStrip(i, place, colour); },
        writer));
  }
  writer.close();
  return counts;
}

}  // namespace

PointCounts writeFusedCloud(const io::OutputPath& path, const io::OutputPath& scratch,
                            io::CloudFormat format, const SharedMap& map, const PointStream& fixed,
                            std::int32_t fixed_date, const std::vector<StripInput>& strips,
                            const FuseOptions& options, const Crs& crs) {
  const bool sorted = format == io::CloudFormat::kCopc;
  const auto kind =
      format == io::CloudFormat::kLaz ? io::LasWriter::Points::kLaz : io::LasWriter::Points::kPlain;
  PointCounts counts;
  {
    io::LasWriter writer(sorted ? scratch : path, outlineOf(map, crs), kind);
    counts = writeRecords(writer, map, fixed, fixed_date, strips, options);
  }
  if (!sorted) return counts;
  io::copyLas(scratch.file(), path, format);
  std::error_code ignored;
  std::filesystem::remove(scratch.file(), ignored);
  return counts;
}

}  // namespace agricolmap::fuse
