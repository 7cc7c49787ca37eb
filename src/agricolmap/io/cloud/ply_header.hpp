// The header of a PLY file: what it announces, checked as far as it can be without the data.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/cloud/named_fields.hpp"
#include "agricolmap/io/cloud/point_source.hpp"

namespace agricolmap::io {

struct PlyProperty {
  std::string name;
  ScalarType type = ScalarType::kFloat32;     ///< of the value, or of a list's items
  std::optional<ScalarType> list_count = {};  ///< type of the length when it is a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  bool hasLists() const;
  /// As for findField.
  std::vector<std::string_view> valueNames() const;
  /// Bytes of one binary item; of its fixed part when it has lists.
  std::size_t fixedBytes() const;
};

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
  std::size_t bytes = 0;  ///< length of the header: the data begin here
  char line_end = '\n';   ///< of the header and, where it is text, of what follows
};

/// Whether the name of an element is that of the points.
bool isVertex(std::string_view element);

/// The element of the points. Throws InputError when there is none.
const PlyElement& vertexOf(const PlyHeader& header, const std::string& name);
/// The names of all properties as one text.
std::string fieldsOf(const PlyElement& vertex);
/// Which properties x, y and z are. Throws InputError when one is missing.
ThreeFields coordinatesOf(const PlyElement& vertex, const std::string& name);

/// Types that nobody needs may be unknown. Throws InputError with file and line.
PlyHeader parsePlyHeader(std::string_view text, const std::string& name);

}  // namespace agricolmap::io
