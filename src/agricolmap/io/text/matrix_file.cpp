#include "agricolmap/io/text/matrix_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/text/number_file.hpp"

namespace agricolmap::io {
namespace {

/// A transform between two maps in metres: scales beyond these are a mistake (units, rows swapped).
constexpr double kMinDeterminant = 1e-9;
constexpr double kMaxDeterminant = 1e9;
constexpr double kLastRowTolerance = 1e-9;

constexpr std::size_t kMatrixNumbers = 16;
constexpr std::size_t kTruthNumbers = 14;

using RowMajor34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

Eigen::Affine3d affineFrom(const std::vector<double>& numbers, const std::filesystem::path& path) {
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.matrix().topRows<3>() = Eigen::Map<const RowMajor34>(numbers.data());
  const double determinant = affine.linear().determinant();
  if (!(std::abs(determinant) >= kMinDeterminant && std::abs(determinant) <= kMaxDeterminant)) {
    throw InputError(fmt::format("{}: its linear part has determinant {}: not a usable transform",
                                 path.string(), determinant));
  }
  return affine;
}

Eigen::Affine3d matrixFrom(const std::vector<double>& n, const std::filesystem::path& path) {
  if (n.size() != kMatrixNumbers) {
    throw InputError(fmt::format("{}: {} numbers; a 4x4 matrix has 16", path.string(), n.size()));
  }
  const Eigen::RowVector4d last(n[12], n[13], n[14], n[15]);
  if ((last - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff() > kLastRowTolerance) {
    throw InputError(fmt::format(
        "{}: the last row is {} {} {} {}, not 0 0 0 1 (rows must come first, not columns)",
        path.string(), n[12], n[13], n[14], n[15]));
  }
  return affineFrom(n, path);
}

}  // namespace

Eigen::Affine3d readMatrix(const std::filesystem::path& path) {
  return matrixFrom(readNumbers(path).numbers, path);
}

Eigen::Affine3d readTransform(const std::filesystem::path& path) {
  const std::vector<double> numbers = readNumbers(path).numbers;
  if (numbers.size() == kTruthNumbers) return affineFrom(numbers, path);
  if (numbers.size() == kMatrixNumbers) return matrixFrom(numbers, path);
  throw InputError(fmt::format(
      "{}: {} numbers; a transform is a 4x4 matrix (16) or a 3x4 affine and 2 scales (14)",
      path.string(), numbers.size()));
}

void writeMatrix(const OutputPath& path, const Eigen::Affine3d& target_from_source,
                 const std::string& comment) {
  std::string text;
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    text += fmt::format("# {}\n", comment.substr(begin, end - begin));
    begin = end + 1;
  }
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index col = 0; col < 4; ++col) {
      if (col > 0) text += ' ';
      text += exactText(target_from_source.matrix()(row, col));
    }
    text += "\n";
  }
  writeText(path, text);
}

}  // namespace agricolmap::io
