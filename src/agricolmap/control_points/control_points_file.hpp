// Hand-picked pairs as a table of comma-separated values.
#pragma once

#include <filesystem>
#include <vector>

#include "agricolmap/control_points/control_points.hpp"

namespace agricolmap::control_points {

/// Reads a table with a header that names the columns, in any order: name, moving_x, moving_y,
/// moving_z, fixed_x, fixed_y, fixed_z [m] and, if wanted, use (`control` or `check`; empty means
/// control). Other columns are skipped. Separated by commas, or by semicolons or tabs where the
/// header is; fields may be in double quotes; empty lines and lines that begin with `#` are
/// skipped. Throws InputError with file, line, column and remedy.
std::vector<ControlPair> readControlPairs(const std::filesystem::path& path);

}  // namespace agricolmap::control_points
