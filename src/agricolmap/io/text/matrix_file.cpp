#include "agricolmap/io/text/matrix_file.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/number_file.hpp"
#include "agricolmap/io/text/text.hpp"

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

/// Rows on lines of their own, or all of them on one.
bool hasLinesOfMatrix(const std::vector<std::size_t>& lines) {
  const bool one = lines.front() == lines.back();
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i] != lines[i - i % 4]) return false;
    if (i >= 4 && !one && lines[i] == lines[i - 4]) return false;
  }
  return true;
}

/// The values behind a key of JSON: a text or a list, nested or not; nothing where the key is not
/// there. Throws InputError when it is there twice.
std::optional<std::string> valueOf(std::string_view json, const std::string& key,
                                   const std::string& name) {
  const std::string quoted = '"' + key + '"';
  std::size_t at = json.find(quoted);
  if (at == std::string_view::npos) return std::nullopt;
  if (json.find(quoted, at + 1) != std::string_view::npos) {
    throw InputError(fmt::format(
        "{}: has '{}' more than once; write the one that is meant as 16 numbers", name, key));
  }
  at = json.find_first_not_of(": \t\r\n", at + quoted.size());
  if (at == std::string_view::npos) return std::nullopt;
  std::size_t end = at + 1;
  if (json[at] == '"') {
    end = json.find('"', end);
  } else {
    int depth = json[at] == '[' ? 1 : 0;
    for (; end < json.size() && depth > 0; ++end) {
      depth += json[end] == '[' ? 1 : json[end] == ']' ? -1 : 0;
    }
  }
  std::string value(json.substr(at, std::min(end, json.size()) - at));
  for (std::size_t escape = 0; (escape = value.find("\\n", escape)) != std::string::npos;) {
    value.replace(escape, 2, " \n");
  }
  std::replace(value.begin(), value.end(), '"', ' ');
  return value;
}

/// Of PDAL's pipelines and metadata; nothing for other files.
std::optional<Eigen::Affine3d> pdalMatrix(const std::filesystem::path& path) {
  constexpr std::size_t kMostBytes = 1U << 22;
  const MappedFile file(path);
  const std::string_view text = withoutMark(file.text()).substr(0, kMostBytes);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || (text[first] != '{' && text[first] != '[') ||
      text.find('"') == std::string_view::npos) {
    return std::nullopt;
  }
  for (const std::string key : {"composed", "transform", "matrix"}) {
    if (const auto value = valueOf(text, key, path.string())) {
      return matrixFrom(numbersIn(*value, path.string()).numbers, path);
    }
  }
  throw InputError(fmt::format("{}: is JSON without a \"matrix\" of 16 numbers", path.string()));
}

}  // namespace

Eigen::Affine3d readMatrix(const std::filesystem::path& path) {
  if (const auto matrix = pdalMatrix(path)) return *matrix;
  return matrixFrom(readNumbers(path).numbers, path);
}

bool looksLikeMatrix(std::string_view text) {
  constexpr std::size_t kMostBytes = 4096;
  if (text.size() > kMostBytes) return false;
  try {
    const NumberFile file = numbersIn(withoutMark(text), "");
    const std::vector<double>& n = file.numbers;
    return n.size() == kMatrixNumbers && hasLinesOfMatrix(file.lines) && n[12] == 0.0 &&
           n[13] == 0.0 && n[14] == 0.0 && n[15] == 1.0;
  } catch (const InputError&) {
    return false;  // words: names of columns, say
  }
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
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index col = 0; col < 4; ++col) {
      if (col > 0) text += ' ';
      text += exactText(target_from_source.matrix()(row, col));
    }
    text += "\n";
  }
  for (std::size_t begin = 0; begin < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', begin), comment.size());
    text += fmt::format("# {}\n", comment.substr(begin, end - begin));
    begin = end + 1;
  }
  writeText(path, text);
}

}  // namespace agricolmap::io
