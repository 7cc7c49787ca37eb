// Writing point clouds: binary little-endian PLY and PCD, LAS, LAZ.
#pragma once

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/point_move.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Writes the cloud, coordinates as doubles, in those of its file, and its colours if it has any.
/// Throws OutputError on any failure; what has been written by then stays, so write into a
/// StagedOutput.
void writePly(const OutputPath& path, const Cloud& cloud);

/// The same after moving every point: file coordinates → target file coordinates, in double. Works
/// block by block without a second copy of the cloud.
void writePly(const OutputPath& path, const Cloud& cloud, const PointMove& target_from_file);

/// Writes binary PCD 0.7, coordinates as doubles, colours packed as `rgb`, after moving every
/// point.
void writePcd(const OutputPath& path, const Cloud& cloud, const PointMove& target_from_file);

/// As writePly, in any of the formats; LAS is in millimetres. Throws UsageError for LAZ where there
/// is no LASzip.
void writeCloud(const OutputPath& path, const Cloud& cloud, CloudFormat format,
                const PointMove& target_from_file = {});

}  // namespace agricolmap::io
