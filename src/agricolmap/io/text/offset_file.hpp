// `offset.xyz`: where a cloud's local coordinates lie in the world.
//
// One line, `x y z` or `x y z roll pitch yaw`, metres and degrees; `#` begins a comment. It means
//
//   world_from_cloud = T(x, y, z) · Rz(yaw) · Ry(pitch) · Rx(roll),
//
// right-handed rotations about the fixed axes x, then y, then z (a yaw of 90° turns the cloud's x
// axis north when x is east and y is north).
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Reads an offset file, also as OpenDroneMap writes it (coords.txt,
/// odm_georeferencing_model_geo.txt: "WGS84 UTM 32N", then "x y"). Throws InputError with file and
/// line.
Eigen::Affine3d readOffset(const std::filesystem::path& path);

/// The offset beside a cloud: `<stem>.offset.xyz` in the cloud's folder, else `offset.xyz` there,
/// else nothing.
std::optional<Eigen::Affine3d> readOffsetBeside(const std::filesystem::path& cloud_file);

/// Files in the folder of a cloud that may be its offset, but not by their names: Pix4D's
/// *_offset.xyz, OpenDroneMap's coords.txt, `<stem>.offset.xyz` of a cloud that is not there.
/// Sorted; empty where the cloud has one that counts.
std::vector<std::string> offsetsPassedBy(const std::filesystem::path& cloud_file);

/// The line of an offset file, six numbers. Throws UsageError when `world_from_cloud` is not rigid.
std::string offsetLine(const Eigen::Affine3d& world_from_cloud);

/// Writes an offset file with six numbers that read back the same to rounding. Throws UsageError
/// when `world_from_cloud` is not rigid, OutputError when it cannot be written.
void writeOffset(const OutputPath& path, const Eigen::Affine3d& world_from_cloud);

}  // namespace agricolmap::io
