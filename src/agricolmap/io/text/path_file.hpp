// The path that a robot drove, as text: one place a line.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Places in the order of driving [m], in the coordinates of the robot's cloud. Lines are `x y`,
/// `x y z`, `t x y z` or `t x y z qx qy qz qw` (as of the TUM data sets), all of one kind; times
/// and attitudes are not used. Blanks, commas, semicolons and tabs separate, `#` begins a comment.
/// A first line of names (`x`, `y` and, if it likes, `z`, among any others) says which columns
/// count. Without a height z is 0. Throws InputError with file, line and remedy.
std::vector<Eigen::Vector3d> readPath(const std::filesystem::path& path);

/// Writes `x y z` lines. `comment` goes first, each of its lines behind a `#`.
void writePath(const OutputPath& path, const std::vector<Eigen::Vector3d>& places,
               const std::string& comment = "");

}  // namespace agricolmap::io
