// A cloud's file moved into another one, point by point.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "agricolmap/io/cloud/cloud_format.hpp"
#include "agricolmap/io/cloud/cloud_move.hpp"
#include "agricolmap/io/cloud/point_mover.hpp"
#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Whether all attributes of a file are kept on the way between these formats, in constant memory:
/// from LAS, LAZ and COPC to each other, from PLY to PLY and from PCD to PCD.
bool keepsAttributes(CloudFormat from, CloudFormat to);

/// The format of a cloud's file. Throws InputError when it is none that is known.
CloudFormat formatOf(const std::filesystem::path& file);

/// Writes the points of `from`, moved, in `format`. Where attributes are kept, PLY and PCD keep all
/// points, those that are not finite as they stand, coordinates in the types that they have unless
/// these are too coarse where the points come to lie, and normals are turned; text stays text.
/// Else coordinates and colours pass by (streamCloud) and are written. Throws InputError when most
/// of the points are far from where the move belongs, and as readers and writers do.
CopiedCloud moveFile(const std::filesystem::path& from, const OutputPath& to, CloudFormat format,
                     const CloudMove& move, const CopyProgress& progress = {});

/// For moveFile: PLY to PLY and PCD to PCD. Nothing where lists among binary vertices, or before
/// them, hide where these are.
std::optional<CopiedCloud> movePly(const std::filesystem::path& from, const OutputPath& to,
                                   const CloudMove& move, const CopyProgress& progress);
CopiedCloud movePcd(const std::filesystem::path& from, const OutputPath& to, const CloudMove& move,
                    const CopyProgress& progress);

/// What callers of these should know of how points fared. Throws InputError when most are far.
void noteTally(const MoveTally& tally, const std::string& file, CopiedCloud& copied);
/// That coordinates became doubles, and why.
void noteDouble(const PointMover& mover, const std::string& file, CopiedCloud& copied);

}  // namespace agricolmap::io
