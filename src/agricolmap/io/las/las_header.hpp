// What a LAS file (1.0 to 1.5; LAZ and COPC are LAS, too) says of itself, on the assumption that it
// lies: every count and offset is held against the file's size before it is used.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/las/las_layout.hpp"

namespace agricolmap::io {

/// A variable length record, extended or not: what programs keep beside the points.
struct LasRecord {
  std::string user;  ///< "LASF_Projection"
  std::uint16_t id = 0;
  std::string description;
  std::span<const std::byte> data;  ///< within the file
  bool extended = false;            ///< stands behind the points
};

struct LasHeader {
  int minor = 0;            ///< of version 1.minor
  std::size_t size = 0;     ///< bytes of the header alone
  std::uint16_t flags = 0;  ///< "global encoding"
  bool compressed = false;  ///< LAZ
  LasLayout layout;
  std::uint64_t points = 0;
  std::size_t points_begin = 0;  ///< offset of the first byte of point data
  /// x = scale * X + offset, as in the file: metres only where its coordinate system says so.
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();
  std::vector<LasRecord> records;     ///< those that lie within the file
  std::vector<std::string> warnings;  ///< lies that do no harm

  /// The first record of this user and number, or none.
  const LasRecord* find(std::string_view user, std::uint16_t id) const;
  /// Coordinates of a point's record, in units of the file.
  Eigen::Vector3d pointOf(const std::byte* record) const {
    return {scale.x() * loadLe<std::int32_t>(record) + offset.x(),
            scale.y() * loadLe<std::int32_t>(record + 4) + offset.y(),
            scale.z() * loadLe<std::int32_t>(record + 8) + offset.z()};
  }
};

/// Whether a file begins as LAS does.
bool looksLikeLas(std::string_view text);

/// Reads the header and the variable length records. The bytes must outlive it. Throws InputError
/// naming `name` and the fault where points cannot be read; a bounding box that is wrong, records
/// beyond the file and the like are warnings. Uncompressed points are within the file.
LasHeader parseLasHeader(std::span<const std::byte> bytes, const std::string& name);

}  // namespace agricolmap::io
