// Writing point clouds: binary little-endian PLY.
#pragma once

#include <Eigen/Geometry>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Writes the cloud, coordinates as doubles, in those of its file, and its colours if it has any.
/// Throws OutputError on any failure; what has been written by then stays, so write into a
/// StagedOutput.
void writePly(const OutputPath& path, const Cloud& cloud);

/// The same after moving every point: file coordinates → target file coordinates, in double. Works
/// block by block without a second copy of the cloud.
void writePly(const OutputPath& path, const Cloud& cloud, const Eigen::Affine3d& target_from_file);

}  // namespace agricolmap::io
