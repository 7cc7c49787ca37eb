#include "agricolmap/io/cloud/ply_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// No sensible header is longer; keeps messages apt when a binary file only begins with "ply".
constexpr std::size_t kMaxHeaderBytes = 1U << 20;

std::optional<ScalarType> scalarType(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, ScalarType>, 18> kNames{{
      {"char", ScalarType::kInt8},
      {"int8", ScalarType::kInt8},
      {"uchar", ScalarType::kUint8},
      {"uint8", ScalarType::kUint8},
      {"short", ScalarType::kInt16},
      {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16},
      {"uint16", ScalarType::kUint16},
      {"int", ScalarType::kInt32},
      {"int32", ScalarType::kInt32},
      {"uint", ScalarType::kUint32},
      {"uint32", ScalarType::kUint32},
      {"int64", ScalarType::kInt64},
      {"uint64", ScalarType::kUint64},
      {"float", ScalarType::kFloat32},
      {"float32", ScalarType::kFloat32},
      {"double", ScalarType::kFloat64},
      {"float64", ScalarType::kFloat64},
  }};
  for (const auto& [name, type] : kNames) {
    if (name == word) return type;
  }
  return std::nullopt;
}

/// Parses line by line; keeps the place for messages.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name)
      : text_(text), rest_(text.substr(0, kMaxHeaderBytes)), name_(name) {
    header_.line_end = lineEndOf(text);
  }

  PlyHeader parse() {
    std::string_view first = nextLine();
    if (takeWord(first) != "ply") fail("a PLY file begins with a line 'ply'");
    parseFormat();
    for (;;) {
      if (rest_.empty()) fail("the header has no 'end_header'");
      std::string_view line = nextLine();
      const std::string_view keyword = takeWord(line);
      if (keyword == "end_header") break;
      if (keyword == "comment" || keyword == "obj_info" || keyword.empty()) continue;
      if (keyword == "element") {
        parseElement(splitWords(line));
      } else if (keyword == "property") {
        parseProperty(splitWords(line));
      } else {
        fail("expected element, property, comment, obj_info or end_header");
      }
    }
    header_.bytes = static_cast<std::size_t>(rest_.data() - text_.data());
    return std::move(header_);
  }

 private:
  std::string_view nextLine() {
    ++line_;
    return takeLine(rest_, header_.line_end);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", name_, line_, what));
  }

  void parseFormat() {
    std::vector<std::string_view> words;
    do {
      if (rest_.empty()) fail("the header ends before its 'format'");
      words = splitWords(nextLine());
    } while (words.empty() || words[0] == "comment" || words[0] == "obj_info");
    if (words.size() != 3 || words[0] != "format") fail("expected 'format <encoding> 1.0'");
    if (words[2] != "1.0") fail(fmt::format("unknown PLY version '{}'", words[2]));
    if (words[1] == "ascii") {
      header_.format = PlyFormat::kAscii;
    } else if (words[1] == "binary_little_endian") {
      header_.format = PlyFormat::kLittleEndian;
    } else if (words[1] == "binary_big_endian") {
      header_.format = PlyFormat::kBigEndian;
    } else {
      fail(fmt::format("unknown encoding '{}'", words[1]));
    }
  }

  void parseElement(const std::vector<std::string_view>& words) {
    if (words.size() != 2) fail("expected 'element <name> <count>'");
    const auto count = parseInteger(words[1]);
    if (!count || *count < 0) {
      fail(fmt::format("'{}' is no count of elements", words[1]));
    }
    if (isVertex(words[0]) && hasVertex()) fail("element 'vertex' is there twice");
    header_.elements.push_back({std::string(words[0]), static_cast<std::uint64_t>(*count), {}});
  }

  bool hasVertex() const {
    return std::any_of(header_.elements.begin(), header_.elements.end(),
                       [](const PlyElement& e) { return isVertex(e.name); });
  }

  /// What stands behind the vertices is not read, and text needs no types: any will do there.
  ScalarType typeOrFail(std::string_view word) const {
    if (const auto type = scalarType(word)) return *type;
    const bool behind = hasVertex() && !isVertex(header_.elements.back().name);
    if (!behind && header_.format != PlyFormat::kAscii) {
      fail(fmt::format("unknown type '{}'", word));
    }
    return ScalarType::kFloat64;
  }

  void parseProperty(const std::vector<std::string_view>& words) {
    if (header_.elements.empty()) fail("a property before the first element");
    const bool list = !words.empty() && words[0] == "list";
    if (words.size() != (list ? 4U : 2U)) {
      fail("expected 'property <type> <name>' or 'property list <type> <type> <name>'");
    }
    PlyProperty property;
    property.name = words.back();
    property.type = typeOrFail(words[list ? 2 : 0]);
    if (list) {
      property.list_count = typeOrFail(words[1]);
      if (scalarType(words[1]) && isFloating(*property.list_count)) {
        fail("the length of a list cannot be a float");
      }
    }
    header_.elements.back().properties.push_back(std::move(property));
  }

  std::string_view text_;
  std::string_view rest_;
  const std::string& name_;
  std::size_t line_ = 0;
  PlyHeader header_;
};

}  // namespace

bool isVertex(std::string_view element) { return lowerCase(element) == "vertex"; }

bool PlyElement::hasLists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& p) { return p.list_count.has_value(); });
}

std::vector<std::string_view> PlyElement::valueNames() const {
  std::vector<std::string_view> names;
  for (const PlyProperty& p : properties)
    names.push_back(p.list_count ? "" : std::string_view(p.name));
  return names;
}

std::size_t PlyElement::fixedBytes() const {
  std::size_t bytes = 0;
  for (const PlyProperty& p : properties) bytes += sizeOf(p.list_count.value_or(p.type));
  return bytes;
}

const PlyElement& vertexOf(const PlyHeader& header, const std::string& name) {
  for (const PlyElement& element : header.elements) {
    if (isVertex(element.name)) return element;
  }
  throw InputError(fmt::format("{}: the header has no element 'vertex'", name));
}

std::string fieldsOf(const PlyElement& vertex) {
  std::vector<std::string> names;
  for (const PlyProperty& property : vertex.properties) names.push_back(property.name);
  return fieldList(names);
}

ThreeFields coordinatesOf(const PlyElement& vertex, const std::string& name) {
  if (const auto xyz = findFields(vertex.valueNames(), {"x", "y", "z"}, name)) return *xyz;
  throw InputError(fmt::format("{}: its vertices lack one of the properties x, y, z (they have {})",
                               name, fieldsOf(vertex)));
}

PlyHeader parsePlyHeader(std::string_view text, const std::string& name) {
  return Parser(text, name).parse();
}

}  // namespace agricolmap::io
