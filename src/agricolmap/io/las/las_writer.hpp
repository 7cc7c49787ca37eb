// Writing LAS and LAZ, record by record.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "agricolmap/io/las/las_header.hpp"
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

/// Takes records and puts them behind a header that is right in the end. Throws OutputError.
class LasWriter {
 public:
  /// Throws UsageError for LAZ in a build without LASzip.
  LasWriter(const OutputPath& path, LasOutline outline, bool compressed);
  ~LasWriter();
  LasWriter(const LasWriter&) = delete;
  LasWriter& operator=(const LasWriter&) = delete;

  /// `count` records of the outline's layout.
  void write(const std::byte* records, std::size_t count);
  /// Must be called last.
  void close();
  std::uint64_t points() const { return points_; }

  /// How points are compressed.
  class Encoder {
   public:
    virtual ~Encoder() = default;
    virtual void write(const std::byte* records, std::size_t count) = 0;
    /// Writes what is left; no point follows.
    virtual void close() = 0;
  };

 private:
  std::vector<std::byte> head() const;
  void count(const std::byte* record);

  LasOutline outline_;
  bool compressed_;
  FileSink sink_;
  std::unique_ptr<Encoder> encoder_;
  std::uint64_t extended_begin_ = 0;  ///< of the extended records, once known
  std::uint64_t points_ = 0;
  std::array<std::uint64_t, 15> by_return_{};
  std::array<std::int32_t, 3> low_{};
  std::array<std::int32_t, 3> high_{};
};

/// LASzip's record for points of this layout: what a LAZ file says of its compression.
std::vector<std::byte> lazRecord(const LasLayout& layout);

/// Compresses into `sink`, behind what was written to it. Both from laz_writer.cpp or, in a
/// build without LASzip, without_laszip.cpp, where they throw UsageError.
std::unique_ptr<LasWriter::Encoder> lazEncoder(FileSink& sink, const LasLayout& layout);

}  // namespace agricolmap::io
