// Writing point clouds: binary little-endian PLY.
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

struct PlyWriteOptions {
  /// Coordinates as 32-bit floats: half the size, for small local frames. Refused (UsageError) when
  /// the result lies farther than 10 km from zero, where floats get coarser than 1 mm.
  bool float_coordinates = false;
  bool colours = true;                     ///< write colours where the cloud has them
  std::vector<std::string> comments = {};  ///< lines for the header
};

/// Writes the cloud in the coordinates of its file. Throws OutputError on any failure; what has
/// been written by then stays, so write into a StagedOutput.
void writePly(const OutputPath& path, const Cloud& cloud, const PlyWriteOptions& options = {});

/// The same after moving every point: file coordinates → target file coordinates, in double. Works
/// block by block without a second copy of the cloud.
void writePly(const OutputPath& path, const Cloud& cloud, const Eigen::Affine3d& target_from_file,
              const PlyWriteOptions& options = {});

}  // namespace agricolmap::io
