#include "agricolmap/io/las/las_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/las/laz_chunks.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kRecordHeader = 54;
constexpr std::size_t kExtendedRecordHeader = 60;
constexpr std::size_t kMostInRecord = 65535;
constexpr std::uint16_t kWktFlag = 0x10;
constexpr std::uint16_t kWaveFlags = 0x06;  ///< wave packets within the file, or beside it
constexpr std::uint16_t kWkt = 2112;
constexpr std::size_t kChunk = 50000;  ///< points of a chunk of LAZ, as LASzip's own
/// Chunks that are compressed side by side, and so wait in memory.
constexpr std::size_t kTogether = 8;

std::size_t headerSize(int minor) { return minor >= 4 ? 375 : minor == 3 ? 235 : 227; }

bool standsBehind(const LasOwnRecord& record) {
  return record.extended || record.data.size() > kMostInRecord;
}

void append(std::vector<std::byte>& to, std::span<const std::byte> bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// A record with what precedes it.
void appendRecord(const LasOwnRecord& record, std::vector<std::byte>& to) {
  const bool extended = standsBehind(record);
  std::array<std::byte, kExtendedRecordHeader> head{};
  std::memcpy(&head[2], record.user.data(), std::min<std::size_t>(16, record.user.size()));
  storeLe(&head[18], record.id);
  if (extended) {
    storeLe(&head[20], static_cast<std::uint64_t>(record.data.size()));
  } else {
    storeLe(&head[20], static_cast<std::uint16_t>(record.data.size()));
  }
  std::memcpy(&head[extended ? 28 : 22], record.description.data(),
              std::min<std::size_t>(32, record.description.size()));
  append(to, std::span(head).first(extended ? kExtendedRecordHeader : kRecordHeader));
  append(to, record.data);
}

/// How a file is laid out, not what it is about.
bool isLayout(const LasRecord& record) {
  constexpr std::uint16_t kWavePackets = 65535;
  return record.user == kLazUser || record.user == "copc" ||
         (record.user == "LASF_Spec" && record.id == kWavePackets);
}

}  // namespace

bool LasOutline::store(const Eigen::Vector3d& point, std::byte* record) const {
  constexpr double kMost = std::numeric_limits<std::int32_t>::max();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double steps = std::round((point[axis] - offset[axis]) / scale[axis]);
    if (!(std::abs(steps) <= kMost)) return false;
    storeLe(record + 4 * axis, static_cast<std::int32_t>(steps));
  }
  return true;
}

void LasOutline::setCrs(const std::string& wkt) {
  std::erase_if(records, [](const LasOwnRecord& record) {
    return record.user == "LASF_Projection" || (record.user == "liblas" && record.id == kWkt);
  });
  flags = static_cast<std::uint16_t>(flags & ~kWktFlag);
  if (wkt.empty()) return;
  minor = std::max(minor, 4);
  flags = static_cast<std::uint16_t>(flags | kWktFlag);
  const auto bytes = std::as_bytes(std::span(wkt.c_str(), wkt.size() + 1));
  records.push_back({"LASF_Projection", kWkt, "OGC WKT", {bytes.begin(), bytes.end()}, false});
}

LasOutline lasOutline(std::span<const std::byte> bytes, const LasHeader& header) {
  LasOutline outline;
  // What was added since LAS 1.2 is needed for extended records and points alone.
  outline.minor = std::clamp(header.minor, 2, 4);
  outline.layout = header.layout;
  if (header.layout.extended) outline.minor = 4;
  outline.scale = header.scale;
  outline.offset = header.offset;
  outline.flags = static_cast<std::uint16_t>(header.flags & ~kWaveFlags);
  outline.source = loadLe<std::uint16_t>(&bytes[4]);
  std::copy_n(&bytes[8], outline.project.size(), outline.project.begin());
  std::copy_n(&bytes[26], outline.system.size(), outline.system.begin());
  outline.day = loadLe<std::uint16_t>(&bytes[90]);
  outline.year = loadLe<std::uint16_t>(&bytes[92]);
  for (const LasRecord& record : header.records) {
    if (isLayout(record)) continue;
    outline.records.push_back({record.user,
                               record.id,
                               record.description,
                               {record.data.begin(), record.data.end()},
                               record.extended});
  }
  return outline;
}

LasOutline lasOutline(bool colours) {
  LasOutline outline;
  outline.layout = lasLayout(colours ? 7 : 6);
  outline.flags = kWktFlag;  // as points of these formats must say
  return outline;
}

LasTally::LasTally() {
  low.fill(std::numeric_limits<std::int32_t>::max());
  high.fill(std::numeric_limits<std::int32_t>::min());
}

void LasTally::add(const std::byte* records, std::size_t count, const LasLayout& layout) {
  const unsigned mask = layout.extended ? 0x0FU : 0x07U;
  std::array<std::uint64_t, 16> returns{};
  for (std::size_t i = 0; i < count; ++i, records += layout.length) {
    ++returns[std::to_integer<unsigned>(records[14]) & mask];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto value = loadLe<std::int32_t>(records + 4 * axis);
      low[axis] = std::min(low[axis], value);
      high[axis] = std::max(high[axis], value);
    }
  }
  points += count;
  for (std::size_t i = 0; i < by_return.size(); ++i) by_return[i] += returns[i + 1];
}

LasTally& LasTally::operator+=(const LasTally& other) {
  points += other.points;
  for (std::size_t i = 0; i < by_return.size(); ++i) by_return[i] += other.by_return[i];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::min(low[axis], other.low[axis]);
    high[axis] = std::max(high[axis], other.high[axis]);
  }
  return *this;
}

LasWriter::LasWriter(const OutputPath& path, LasOutline outline, Points kind)
    : outline_(std::move(outline)), kind_(kind), sink_(path) {
  if (kind_ != Points::kPlain) {
    outline_.records.push_back({kLazUser, kLazRecord, "http://laszip.org",
                                lazRecord(outline_.layout, kind_ == Points::kChunks), false});
  }
  const bool behind = std::any_of(outline_.records.begin(), outline_.records.end(), standsBehind);
  if (behind) outline_.minor = std::max(outline_.minor, 4);
  sink_.write(head());
  points_begin_ = sink_.size();
  // Where the chunk table is, once it is known.
  if (kind_ != Points::kPlain) sink_.write(std::array<std::byte, 8>{});
}

void LasWriter::write(const std::byte* records, std::size_t count) {
  LasTally tally;
  tally.add(records, count, outline_.layout);
  write(records, count, tally);
}

void LasWriter::write(const std::byte* records, std::size_t count, const LasTally& tally) {
  tally_ += tally;
  const std::span bytes(records, count * outline_.layout.length);
  if (kind_ == Points::kPlain) {
    sink_.write(bytes);
    return;
  }
  append(pending_, bytes);
  compressPending(false);
}

void LasWriter::compressPending(bool all) {
  const std::size_t length = outline_.layout.length;
  const std::size_t points = pending_.size() / length;
  const std::size_t chunks = all ? (points + kChunk - 1) / kChunk : points / kChunk;
  if (chunks == 0 || (!all && chunks < kTogether)) return;
  std::vector<std::vector<std::byte>> compressed(chunks);
  const auto countOf = [&](std::size_t i) { return std::min(kChunk, points - i * kChunk); };
  parallelFor(chunks, [&](std::size_t i) {
    compressed[i] = lazChunk(&pending_[i * kChunk * length], countOf(i), outline_.layout);
  });
  for (std::size_t i = 0; i < chunks; ++i) {
    sink_.write(compressed[i]);
    chunks_.push_back(
        {static_cast<std::uint32_t>(countOf(i)), static_cast<std::uint32_t>(compressed[i].size())});
  }
  const std::size_t used = std::min(points, chunks * kChunk) * length;
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(used));
}

std::uint64_t LasWriter::writeChunk(std::span<const std::byte> chunk, const LasTally& tally) {
  tally_ += tally;
  const std::uint64_t begin = sink_.size();
  sink_.write(chunk);
  chunks_.push_back(
      {static_cast<std::uint32_t>(tally.points), static_cast<std::uint32_t>(chunk.size())});
  return begin;
}

std::uint64_t LasWriter::endPoints() {
  if (kind_ != Points::kPlain && !ended_) {
    compressPending(true);
    std::array<std::byte, 8> at{};
    storeLe(at.data(), static_cast<std::uint64_t>(sink_.size()));
    sink_.write(lazChunkTable(chunks_, kind_ == Points::kChunks));
    sink_.rewrite(points_begin_, at);
  }
  ended_ = true;
  return sink_.size();
}

void LasWriter::close() {
  const std::uint64_t end = endPoints();
  if (points() > 0xFFFFFFFFU && outline_.minor < 4) {
    throw OutputError(fmt::format("LAS 1.{} has no room for {} points", outline_.minor, points()));
  }
  std::vector<std::byte> behind;
  for (const LasOwnRecord& record : outline_.records) {
    if (standsBehind(record)) appendRecord(record, behind);
  }
  if (!behind.empty()) {
    extended_begin_ = end;
    sink_.write(behind);
  }
  sink_.rewrite(0, head());
  sink_.close();
}

std::vector<std::byte> LasWriter::head() const {
  std::array<std::byte, 375> head{};
  std::byte* const to = head.data();
  const std::size_t size = headerSize(outline_.minor);
  std::vector<std::byte> records;
  std::uint32_t before = 0;
  std::uint32_t behind = 0;
  for (const LasOwnRecord& record : outline_.records) {
    (standsBehind(record) ? behind : before) += 1;
    if (!standsBehind(record)) appendRecord(record, records);
  }
  std::memcpy(to, "LASF", 4);
  storeLe(to + 4, outline_.source);
  storeLe(to + 6, outline_.flags);
  std::memcpy(to + 8, outline_.project.data(), outline_.project.size());
  to[24] = std::byte{1};
  to[25] = static_cast<std::byte>(outline_.minor);
  std::memcpy(to + 26, outline_.system.data(), outline_.system.size());
  std::memcpy(to + 58, "AgriColMap", 10);
  storeLe(to + 90, outline_.day);
  storeLe(to + 92, outline_.year);
  storeLe(to + 94, static_cast<std::uint16_t>(size));
  storeLe(to + 96, static_cast<std::uint32_t>(size + records.size()));
  storeLe(to + 100, before);
  to[104] = static_cast<std::byte>(outline_.layout.format | (kind_ != Points::kPlain ? 0x80 : 0));
  storeLe(to + 105, static_cast<std::uint16_t>(outline_.layout.length));
  const bool legacy = !outline_.layout.extended && points() <= 0xFFFFFFFFU;
  if (legacy) storeLe(to + 107, static_cast<std::uint32_t>(points()));
  for (std::size_t i = 0; i < 5 && legacy; ++i) {
    storeLe(to + 111 + 4 * i, static_cast<std::uint32_t>(tally_.by_return[i]));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    storeLe(to + 131 + 8 * axis, outline_.scale[i]);
    storeLe(to + 155 + 8 * axis, outline_.offset[i]);
    if (points() == 0) continue;
    const double a = outline_.scale[i] * tally_.low[axis] + outline_.offset[i];
    const double b = outline_.scale[i] * tally_.high[axis] + outline_.offset[i];
    storeLe(to + 179 + 16 * axis, std::max(a, b));
    storeLe(to + 187 + 16 * axis, std::min(a, b));
  }
  storeLe(to + 235, extended_begin_);
  storeLe(to + 243, behind);
  storeLe(to + 247, points());
  for (std::size_t i = 0; i < tally_.by_return.size(); ++i)
    storeLe(to + 255 + 8 * i, tally_.by_return[i]);

  std::vector<std::byte> bytes(head.begin(), head.begin() + static_cast<std::ptrdiff_t>(size));
  append(bytes, records);
  return bytes;
}

}  // namespace agricolmap::io
