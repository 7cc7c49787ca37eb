// LAS, LAZ and COPC in constant memory: of files of the same kinds, all attributes kept, and of
// points that pass by.
#pragma once

#include <filesystem>
#include <optional>

#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/cloud_move.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Copies the points of a LAS or LAZ file (COPC loses its order) with all that they have and all
/// variable length records. Without `move` their records stay as they are to the bit, but for
/// records that describe the file itself; with it coordinates are written in the steps of the
/// source where these are metres and between 10 µm and 1 cm, else in millimetres. What is said of
/// the coordinate system becomes that of the move, or `crs`, unless it is empty. To COPC, points of
/// the old formats 0 to 5 are lifted to those of LAS 1.4. Throws InputError and OutputError, and
/// UsageError for LAZ in a build without LASzip.
CopiedCloud copyLas(const std::filesystem::path& from, const OutputPath& to, CloudFormat format,
                    const std::optional<CloudMove>& move = std::nullopt, const Crs& crs = {},
                    const CopyProgress& progress = {});

/// Writes points, in the coordinates of their file, as LAS 1.4 in millimetres, colours in 16 bit.
/// COPC takes three passes or four, the others one. Throws as copyLas and the stream do, and
/// UsageError for points that are more than 2000 km apart.
void writeLas(const OutputPath& path, const PointStream& points, CloudFormat format,
              const PointMove& target_from_file = {});

}  // namespace agricolmap::io
