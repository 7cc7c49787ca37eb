// Writing LAS and LAZ, record by record.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/io/las/las_header.hpp"
#include "agricolmap/io/las/laz_chunk_table.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap::io {

/// A variable length record to be written; one of more than 65535 bytes, or `extended`, stands
/// behind the points, which LAS 1.4 alone has.
struct LasOwnRecord {
  std::string user;
  std::uint16_t id = 0;
  std::string description;
  std::vector<std::byte> data;
  bool extended = false;
};

/// All of a LAS file but its points.
struct LasOutline {
  int minor = 4;
  LasLayout layout;
  Eigen::Vector3d scale = Eigen::Vector3d::Constant(0.001);
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::uint16_t flags = 0;
  std::uint16_t source = 0;
  std::array<std::byte, 16> project{};
  std::array<std::byte, 32> system{};  ///< what made the points
  std::uint16_t day = 0;
  std::uint16_t year = 0;
  std::vector<LasOwnRecord> records;

  /// The records of a point's coordinates, or nothing where they do not fit into 32 bits.
  bool store(const Eigen::Vector3d& point, std::byte* record) const;
  /// The coordinate system that all coordinates are in, instead of what was said of it before.
  void setCrs(const std::string& wkt);
};

/// What `header` has, for a file of the same points. `bytes` is the whole file. Left out is what
/// describes how the file itself is laid out: LASzip's record and those of COPC.
LasOutline lasOutline(std::span<const std::byte> bytes, const LasHeader& header);

/// For points that are nothing but coordinates and perhaps colours.
LasOutline lasOutline(bool colours);

/// What a header says of all points together.
struct LasTally {
  std::uint64_t points = 0;
  std::array<std::uint64_t, 15> by_return{};
  std::array<std::int32_t, 3> low{};
  std::array<std::int32_t, 3> high{};

  LasTally();
  void add(const std::byte* records, std::size_t count, const LasLayout& layout);
  LasTally& operator+=(const LasTally& other);
};

/// Takes records and puts them behind a header that is right in the end. Throws OutputError.
class LasWriter {
 public:
  enum class Points {
    kPlain,
    kLaz,     ///< in chunks of 50 000, compressed side by side
    kChunks,  ///< LAZ, in the chunks that are handed over
  };

  /// Throws UsageError for LAZ in a build without LASzip.
  LasWriter(const OutputPath& path, LasOutline outline, Points kind);
  LasWriter(const LasWriter&) = delete;
  LasWriter& operator=(const LasWriter&) = delete;

  /// `count` records of the outline's layout; `tally` is theirs.
  void write(const std::byte* records, std::size_t count, const LasTally& tally);
  void write(const std::byte* records, std::size_t count);
  /// A chunk as lazChunk makes it, for Points::kChunks; returns where in the file it begins.
  std::uint64_t writeChunk(std::span<const std::byte> chunk, const LasTally& tally);
  /// Nothing but extended records comes behind it; returns where these begin.
  std::uint64_t endPoints();
  /// Must be called last.
  void close();

  /// Records may be changed, but not in size, and extended ones added until `close`.
  LasOutline& outline() { return outline_; }
  const LasTally& tally() const { return tally_; }
  std::uint64_t points() const { return tally_.points; }

 private:
  std::vector<std::byte> head() const;
  void compressPending(bool all);

  LasOutline outline_;
  Points kind_;
  FileSink sink_;
  std::vector<std::byte> pending_;    ///< records that make no chunk yet
  std::vector<LazChunkSize> chunks_;  ///< written so far
  std::size_t points_begin_ = 0;
  bool ended_ = false;
  std::uint64_t extended_begin_ = 0;  ///< of the extended records, once known
  LasTally tally_;
};

/// Whether LAZ and COPC can be read and written here.
bool hasLaz();

/// LASzip's record for points of this layout: what a LAZ file says of its compression. `variable`:
/// its chunks have any number of points.
std::vector<std::byte> lazRecord(const LasLayout& layout, bool variable);

/// Records compressed as one chunk. From several threads at once.
std::vector<std::byte> lazChunk(const std::byte* records, std::size_t count,
                                const LasLayout& layout);

}  // namespace agricolmap::io
