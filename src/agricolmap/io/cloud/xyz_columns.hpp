// Lines of text with a point each, as CloudCompare, Metashape, PDAL and scanners (PTS) write them:
// what separates the values, and which of them are what.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/cloud/ascii_source.hpp"

namespace agricolmap::io {

struct XyzColumns {
  std::size_t begin = 0;  ///< of the first point's line
  char line_end = '\n';
  char separator = ' ';
  bool decimal_comma = false;
  std::vector<AsciiColumn> columns;
  bool colours = false;
  std::string fields;                      ///< for people
  std::optional<std::uint64_t> announced;  ///< how many points: the first line of PTS
};

/// Whether a text begins with lines of numbers, three at least, behind lines of names or comments.
bool looksLikeXyz(std::string_view text);

/// By the names in the last line before the numbers, where there are any (`x y z r g b`,
/// `//X,Y,Z,R,G,B`, `easting;northing;height`), else x, y, z first and colours where values are
/// such. Throws InputError naming the reason where that may be read in two ways.
XyzColumns xyzColumns(std::string_view text, const std::string& name);

}  // namespace agricolmap::io
