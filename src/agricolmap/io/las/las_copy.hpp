// LAS and LAZ from LAS and LAZ, all attributes kept, in constant memory.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/point_move.hpp"
#include "agricolmap/io/cloud/read_options.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// What is done to coordinates on the way from file to file.
struct LasMove {
  const CoordinateMap* map = nullptr;  ///< first, as when the cloud is read
  /// Of the cloud as it was read: points too far from it are left out here, too.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  PointMove target_from_file;  ///< then
  Crs crs;                     ///< of the target
};

struct LasCopied {
  std::uint64_t points = 0;
  std::uint64_t left_out = 0;         ///< that have no place in the target: wild ones
  std::vector<std::string> warnings;  ///< what could not be taken along
};

/// Copies the points of a LAS or LAZ file (COPC loses its order) with all that they have and all
/// variable length records. Without `move` their records stay as they are to the bit, but for
/// records that describe the file itself; with it coordinates are written in the steps of the
/// source where these are metres and between 10 µm and 1 cm, else in millimetres, and the
/// coordinate system is that of the move, if it is known. Throws InputError and OutputError, and
/// UsageError for LAZ in a build without LASzip.
LasCopied copyLas(const std::filesystem::path& from, const OutputPath& to, bool compressed,
                  const std::optional<LasMove>& move = std::nullopt);

/// Writes a cloud, in the coordinates of its file, as LAS 1.4 in millimetres, colours in 16 bit.
void writeLas(const OutputPath& path, const Cloud& cloud, bool compressed,
              const PointMove& target_from_file = {});

}  // namespace agricolmap::io
