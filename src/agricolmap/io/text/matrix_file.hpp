// Transforms as text: `target_from_source` as a 4×4 matrix, row-major, one row a line.
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <string>
#include <string_view>

#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// Reads 16 numbers: finite, last row 0 0 0 1, invertible. Commas, brackets and `#` comments are
/// fine. So is JSON of PDAL: the one "matrix" of a pipeline, or the "composed" one (else the
/// "transform") that its ICP reports. Throws InputError.
Eigen::Affine3d readMatrix(const std::filesystem::path& path);

/// Whether a whole file's text is such a matrix, its rows on four lines or all on one, and nothing
/// else: 16 numbers whose last four are 0 0 0 1.
bool looksLikeMatrix(std::string_view text);

/// Writes 17 significant digits: what is read back is the same to the bit. `comment` goes
/// last, each of its lines behind a `#`: CloudCompare takes a file that begins with one for zeros.
void writeMatrix(const OutputPath& path, const Eigen::Affine3d& target_from_source,
                 const std::string& comment = "");

/// Reads such a matrix or a ground truth as published with the paper's data, told apart by how many
/// numbers there are: 12 of a 3×4 affine, row-major, then the relative scale errors of x and y,
/// which the affine has already.
Eigen::Affine3d readTransform(const std::filesystem::path& path);

}  // namespace agricolmap::io
