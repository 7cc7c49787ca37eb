// The header of a PCD file: what it announces, checked as far as it can be without the data.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/cloud/named_fields.hpp"
#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

struct PcdField {
  std::string name;
  ScalarType type = ScalarType::kFloat32;
  std::uint64_t count = 1;
  std::size_t bytes() const { return count * sizeOf(type); }
};

enum class PcdEncoding { kAscii, kBinary, kCompressed };

struct PcdHeader {
  std::vector<PcdField> fields;
  std::uint64_t points = 0;
  PcdEncoding encoding = PcdEncoding::kAscii;
  std::size_t bytes = 0;  ///< length of the header: the data begin here
  char line_end = '\n';
  std::vector<double> viewpoint;  ///< x y z qw qx qy qz, where it is said

  std::size_t pointBytes() const {
    std::size_t sum = 0;
    for (const PcdField& field : fields) sum += field.bytes();
    return sum;
  }
  /// As for findField.
  std::vector<std::string_view> valueNames() const;
  /// Whether a viewpoint is said that is more than the origin, not turned.
  bool hasPose() const;
};

/// The names of all fields as one text.
std::string fieldsOf(const PcdHeader& header);
/// Which fields x, y and z are. Throws InputError when one is missing.
ThreeFields coordinatesOf(const PcdHeader& header, const std::string& name);

/// Throws InputError with file and line.
PcdHeader parsePcdHeader(std::string_view text, const std::string& name);

}  // namespace agricolmap::io
