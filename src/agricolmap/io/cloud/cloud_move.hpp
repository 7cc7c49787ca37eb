// What becomes of a cloud's coordinates on the way from file to file, and what was written.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/point_move.hpp"
#include "agricolmap/io/cloud/read_options.hpp"

namespace agricolmap::io {

struct CloudMove {
  const CoordinateMap* map = nullptr;  ///< first, as when the cloud is read
  /// About where the cloud lies then: points of LAS that are too far from it are left out.
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  PointMove target_from_file;  ///< then
  Crs crs;                     ///< of the target; empty: as before
};

/// Called now and then, from one thread at a time, with how many points of how many are written or,
/// where they pass by several times, were seen in the present pass.
using CopyProgress = std::function<void(std::size_t points, std::size_t of)>;

struct CopiedCloud {
  std::uint64_t points = 0;
  std::uint64_t left_out = 0;         ///< that have no place in the target: wild ones
  std::vector<std::string> warnings;  ///< what could not be taken along
};

}  // namespace agricolmap::io
