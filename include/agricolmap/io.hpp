// Clouds and transformations from and to files and memory.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"

namespace agricolmap {

/// Reads PLY, PCD, LAS 1.0 to 1.5, lines of text and, in a build with LASzip, LAZ and COPC, told
/// apart by content. Points in file order; those with a NaN, an infinity or a coordinate beyond 1e8
/// m and those marked as withheld are left out and counted. Throws InputError naming file, place
/// and reason when the file is not what its header says.
AGRICOLMAP_EXPORT Cloud readCloud(const std::filesystem::path& path);

/// A cloud from points in memory, by the same rules. `colours` is empty or one per point; `name`
/// stands for the cloud in messages. Throws UsageError when the numbers differ, InputError when no
/// point is usable.
AGRICOLMAP_EXPORT Cloud makeCloud(std::span<const Eigen::Vector3d> points,
                                  std::span<const Rgb> colours = {},
                                  const std::string& name = "points");

/// Writes binary PLY in the coordinates of the cloud's file, as doubles. An existing file is
/// replaced. Throws OutputError; what has been written by then stays.
AGRICOLMAP_EXPORT void writePly(const std::filesystem::path& path, const Cloud& cloud);

/// The same after moving every point: file coordinates → target file coordinates.
AGRICOLMAP_EXPORT void writePly(const std::filesystem::path& path, const Cloud& cloud,
                                const Transform& target_from_file);

/// Writes binary PLY or PCD, LAS, LAZ or COPC (`.copc.laz`), as the file's name ends, after moving
/// every point: file coordinates → target file coordinates. LAS is in millimetres and has a place
/// for the coordinate system. Throws UsageError for another ending, and for LAZ in a build without
/// LASzip; OutputError as writePly does.
AGRICOLMAP_EXPORT void writeCloud(const std::filesystem::path& path, const Cloud& cloud,
                                  const Transform& target_from_file = Transform::Identity());

/// Reads a 4×4 matrix: 16 numbers, row-major, last row 0 0 0 1, invertible. Commas, brackets and
/// `#` comments are fine, and so is PDAL's JSON. Throws InputError.
AGRICOLMAP_EXPORT Transform readMatrix(const std::filesystem::path& path);

/// Writes 17 significant digits: what is read back is the same to the bit. Throws OutputError.
AGRICOLMAP_EXPORT void writeMatrix(const std::filesystem::path& path,
                                   const Transform& target_from_source);

/// The places of a robot in order of driving, for `registerClouds`: lines `x y`, `x y z`,
/// `t x y z` or `t x y z qx qy qz qw`, or columns under a line of names. Throws InputError.
AGRICOLMAP_EXPORT std::vector<Eigen::Vector3d> readPath(const std::filesystem::path& path);

/// World from cloud, by the geotag beside a cloud's file: `<stem>.offset.xyz`, else `offset.xyz` in
/// its folder, else nothing. Throws InputError.
AGRICOLMAP_EXPORT std::optional<Transform> readOffsetBeside(const std::filesystem::path& cloud);

/// Component gdal. A cloud from an orthomosaic and its surface model (OpenDroneMap, Pix4D,
/// Metashape): a point per pixel that has a height. Throws InputError when one of them is not
/// georeferenced in metres, their coordinate systems differ or they do not overlap.
AGRICOLMAP_EXPORT Cloud readOrthomosaic(const std::filesystem::path& ortho,
                                        const std::filesystem::path& surface_model);

/// Component gdal. The coordinate system of a map's file where the file does not say it, or is
/// wrong: a code as EPSG:32632, WKT, PROJ's text or a file with one of these. Empty: what the file
/// says, or a `.prj` beside it.
struct MapFile {
  std::string path;  ///< of a cloud, an orthomosaic, or ORTHO.tif,DSM.tif
  std::string crs = {};
};

/// Two maps in one frame.
struct CloudPair {
  Cloud fixed;
  Cloud moving;
};

/// Component gdal. Reads both maps of a registration into the coordinate system of the fixed one,
/// in metres, as the command line does: feet are turned into metres, another projection into that
/// of the fixed one. What was assumed is among the moving cloud's warnings. Throws InputError as
/// readCloud and readOrthomosaic do and when neither file is projected, UsageError for a system
/// that is not understood.
AGRICOLMAP_EXPORT CloudPair readPair(const MapFile& fixed, const MapFile& moving);

/// Component gdal. Whether both say the same horizontal coordinates, in whatever words; heights may
/// be of different systems. Throws InputError for a `wkt` that is missing or not understood.
AGRICOLMAP_EXPORT bool sameCrs(const Crs& a, const Crs& b);

/// Component gdal. As readPair reads the moving one beside a fixed cloud in this frame.
AGRICOLMAP_EXPORT Cloud readBeside(const Crs& frame, const MapFile& moving);

/// Component gdal. The same of one map alone. `target`: as MapFile::crs, into which it is brought
/// (InputError when the file does not say where it is); empty: it stays in its own, in metres.
AGRICOLMAP_EXPORT Cloud readMap(const MapFile& file, const std::string& target = {});

}  // namespace agricolmap
