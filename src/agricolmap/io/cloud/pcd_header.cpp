#include "agricolmap/io/cloud/pcd_header.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

constexpr std::size_t kMaxHeaderBytes = 1U << 20;
constexpr std::uint64_t kMaxValues = 1U << 20;
constexpr double kPoseTolerance = 1e-9;

/// Parses line by line; keeps the place for messages.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name)
      : text_(text), rest_(text.substr(0, kMaxHeaderBytes)), name_(name) {
    header_.line_end = lineEndOf(text);
  }

  PcdHeader parse() {
    while (!done_) {
      if (rest_.empty()) fail("the header has no DATA line");
      ++line_;
      const std::vector<std::string_view> words = splitWords(takeLine(rest_, header_.line_end));
      if (!words.empty() && !words[0].starts_with('#')) parseLine(words);
    }
    header_.bytes = static_cast<std::size_t>(rest_.data() - text_.data());
    makeFields();
    checkCounts();
    return std::move(header_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", name_, line_, what));
  }

  std::uint64_t countOf(std::string_view word) const {
    const auto value = parseInteger(word);
    if (!value || *value < 0) fail(fmt::format("'{}' is no count", word));
    return static_cast<std::uint64_t>(*value);
  }

  void parseLine(const std::vector<std::string_view>& words) {
    const std::string_view key = words[0];
    const std::vector<std::string_view> values(words.begin() + 1, words.end());
    const auto one = [&] {
      if (values.size() != 1) fail(fmt::format("{} needs one value", key));
      return values[0];
    };
    if (key == "VERSION") {
      static constexpr std::array<std::string_view, 6> kVersions{"0.7", ".7",  "0.6",
                                                                 ".6",  "0.5", ".5"};
      if (std::find(kVersions.begin(), kVersions.end(), one()) == kVersions.end()) {
        fail(fmt::format("unknown PCD version '{}'", one()));
      }
    } else if (key == "FIELDS" || key == "COLUMNS") {
      names_ = values;
    } else if (key == "SIZE") {
      sizes_ = values;
    } else if (key == "TYPE") {
      types_ = values;
    } else if (key == "COUNT") {
      counts_ = values;
    } else if (key == "WIDTH") {
      width_ = countOf(one());
    } else if (key == "HEIGHT") {
      height_ = countOf(one());
    } else if (key == "POINTS") {
      points_ = countOf(one());
    } else if (key == "DATA") {
      parseEncoding(one());
    } else if (key == "VIEWPOINT") {
      parseViewpoint(values);
    } else {
      fail(fmt::format("unknown entry '{}'", key));
    }
  }

  void parseViewpoint(const std::vector<std::string_view>& values) {
    header_.viewpoint.clear();
    for (const std::string_view value : values) {
      const auto number = parseNumber(value);
      if (!number) fail(fmt::format("VIEWPOINT: '{}' is no number", value));
      header_.viewpoint.push_back(*number);
    }
  }

  void parseEncoding(std::string_view word) {
    if (word == "ascii") {
      header_.encoding = PcdEncoding::kAscii;
    } else if (word == "binary") {
      header_.encoding = PcdEncoding::kBinary;
    } else if (word == "binary_compressed") {
      header_.encoding = PcdEncoding::kCompressed;
    } else {
      fail(fmt::format("unknown encoding '{}'", word));
    }
    done_ = true;
  }

  ScalarType typeOf(std::string_view kind, std::string_view size) const {
    static constexpr std::array<std::pair<std::string_view, ScalarType>, 10> kTypes{{
        {"I1", ScalarType::kInt8},
        {"U1", ScalarType::kUint8},
        {"I2", ScalarType::kInt16},
        {"U2", ScalarType::kUint16},
        {"I4", ScalarType::kInt32},
        {"U4", ScalarType::kUint32},
        {"I8", ScalarType::kInt64},
        {"U8", ScalarType::kUint64},
        {"F4", ScalarType::kFloat32},
        {"F8", ScalarType::kFloat64},
    }};
    const std::string word = std::string(kind) + std::string(size);
    for (const auto& [type_name, type] : kTypes) {
      if (type_name == word) return type;
    }
    fail(fmt::format("unknown TYPE {} of SIZE {}", kind, size));
  }

  void makeFields() {
    const std::size_t n = names_.size();
    if (n == 0) fail("the header has no FIELDS");
    // The first versions had neither: all values are floats.
    if (sizes_.empty()) sizes_.assign(n, "4");
    if (types_.empty()) types_.assign(n, "F");
    if (sizes_.size() != n || types_.size() != n || (!counts_.empty() && counts_.size() != n)) {
      fail("FIELDS, SIZE, TYPE and COUNT have different numbers of entries");
    }
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < n; ++i) {
      PcdField field;
      field.name = names_[i];
      field.type = typeOf(types_[i], sizes_[i]);
      if (!counts_.empty()) field.count = countOf(counts_[i]);
      total += field.count;
      if (field.count > kMaxValues || total > kMaxValues) {
        fail(fmt::format("more than {} values a point", kMaxValues));
      }
      header_.fields.push_back(std::move(field));
    }
  }

  void checkCounts() {
    if (width_ && height_) {
      if (*height_ != 0 && *width_ > std::numeric_limits<std::uint64_t>::max() / *height_) {
        fail(fmt::format("absurd size {} x {}", *width_, *height_));
      }
      const std::uint64_t area = *width_ * *height_;
      if (points_ && *points_ != area) {
        fail(fmt::format("POINTS is {}, but WIDTH x HEIGHT is {} x {}", *points_, *width_,
                         *height_));
      }
      points_ = area;
    }
    if (!points_) fail("the header has neither POINTS nor WIDTH and HEIGHT");
    if (*points_ == 0) throw InputError(fmt::format("{}: empty cloud: 0 points", name_));
    header_.points = *points_;
  }

  std::string_view text_;
  std::string_view rest_;
  const std::string& name_;
  std::size_t line_ = 0;
  bool done_ = false;
  PcdHeader header_;
  std::vector<std::string_view> names_;
  std::vector<std::string_view> sizes_;
  std::vector<std::string_view> types_;
  std::vector<std::string_view> counts_;
  std::optional<std::uint64_t> width_;
  std::optional<std::uint64_t> height_;
  std::optional<std::uint64_t> points_;
};

}  // namespace

std::vector<std::string_view> PcdHeader::valueNames() const {
  std::vector<std::string_view> names;
  for (const PcdField& field : fields)
    names.push_back(field.count == 1 ? std::string_view(field.name) : "");
  return names;
}

bool PcdHeader::hasPose() const {
  for (std::size_t i = 0; i < viewpoint.size(); ++i) {
    const double value = i == 3 ? std::abs(viewpoint[i]) - 1.0 : viewpoint[i];
    if (!(std::abs(value) <= kPoseTolerance)) return true;
  }
  return false;
}

std::string fieldsOf(const PcdHeader& header) {
  std::vector<std::string> names;
  for (const PcdField& field : header.fields) names.push_back(field.name);
  return fieldList(names);
}

ThreeFields coordinatesOf(const PcdHeader& header, const std::string& name) {
  if (const auto xyz = findFields(header.valueNames(), {"x", "y", "z"}, name)) return *xyz;
  throw InputError(
      fmt::format("{}: it lacks one of the fields x, y, z (it has {})", name, fieldsOf(header)));
}

PcdHeader parsePcdHeader(std::string_view text, const std::string& name) {
  return Parser(text, name).parse();
}

}  // namespace agricolmap::io
