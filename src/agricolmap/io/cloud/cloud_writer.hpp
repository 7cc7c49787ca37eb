// Writing point clouds, kept ones and those that pass by: binary little-endian PLY and PCD, LAS,
// LAZ and COPC.
#pragma once

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/point_move.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Writes points, and their colours if they have any, after moving every point: coordinates of
/// their file → of the target's, in double. PLY and PCD 0.7 are binary with coordinates as doubles,
/// colours of PCD packed as `rgb`; LAS is in millimetres. Works block by block and keeps nothing;
/// the bytes are the same whether the points are kept or pass by. Throws OutputError on any
/// failure, what the stream throws, and UsageError for text and, where there is no LASzip, LAZ;
/// what has been written by then stays, so write into a StagedOutput.
void writeCloud(const OutputPath& path, const PointStream& points, CloudFormat format,
                const PointMove& target_from_file = {});
void writeCloud(const OutputPath& path, const Cloud& cloud, CloudFormat format,
                const PointMove& target_from_file = {});

/// The same as PLY.
void writePly(const OutputPath& path, const Cloud& cloud, const PointMove& target_from_file = {});

}  // namespace agricolmap::io
