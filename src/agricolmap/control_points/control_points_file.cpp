#include "agricolmap/control_points/control_points_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::control_points {
namespace {

/// Thousands of pairs; more is some other file given by mistake.
constexpr std::size_t kMaxBytes = 1U << 20;

constexpr std::size_t kCoordinates = 6;
constexpr std::array<std::string_view, kCoordinates + 2> kColumns = {
    "moving_x", "moving_y", "moving_z", "fixed_x", "fixed_y", "fixed_z", "name", "use"};
constexpr std::size_t kName = kCoordinates;
constexpr std::size_t kUse = kCoordinates + 1;

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && io::isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && io::isBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lowered(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// Where in the file something is wrong.
struct Where {
  std::string file;
  std::size_t line = 1;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}: line {}: {}", file, line, what));
  }
  [[noreturn]] void fail(std::string_view column, const std::string& what) const {
    throw InputError(fmt::format("{}: line {}, column {}: {}", file, line, column, what));
  }
};

/// The fields of a line without the blanks around them; in double quotes, separators and doubled
/// quotes are text.
std::vector<std::string> fieldsOf(std::string_view line, char separator, const Where& where) {
  std::vector<std::string> fields;
  for (bool more = true; more;) {
    while (line.size() > 0 && io::isBlank(line.front()) && line.front() != separator) {
      line.remove_prefix(1);
    }
    std::string field;
    if (line.starts_with('"')) {
      std::size_t at = 1;
      for (; at < line.size(); ++at) {
        if (line[at] != '"') {
          field += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
          field += line[at++];
        } else {
          break;
        }
      }
      if (at >= line.size()) where.fail("a quote is not closed; names must fit on one line");
      line.remove_prefix(at + 1);
      const std::size_t end = std::min(line.find(separator), line.size());
      if (!trimmed(line.substr(0, end)).empty()) {
        where.fail(fmt::format("text after the quoted field '{}'", field));
      }
    } else {
      field = trimmed(line.substr(0, line.find(separator)));
    }
    fields.push_back(field);
    const std::size_t end = line.find(separator);
    more = end != std::string_view::npos;
    line.remove_prefix(more ? end + 1 : line.size());
  }
  return fields;
}

/// Which field of a row has which of kColumns.
struct Header {
  char separator = ',';
  std::size_t fields = 0;
  std::array<std::optional<std::size_t>, kColumns.size()> at;
};

Header headerOf(std::string_view line, const Where& where) {
  Header header;
  if (line.find(',') == std::string_view::npos) {
    if (line.find(';') != std::string_view::npos) header.separator = ';';
    if (line.find('\t') != std::string_view::npos) header.separator = '\t';
  }
  const std::vector<std::string> names = fieldsOf(line, header.separator, where);
  header.fields = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto* known = std::find(kColumns.begin(), kColumns.end(), lowered(names[i]));
    if (known == kColumns.end()) continue;
    auto& at = header.at.at(static_cast<std::size_t>(known - kColumns.begin()));
    if (at) where.fail(names[i], "the header names this column twice; remove one");
    at = i;
  }
  std::vector<std::string_view> missing;
  for (std::size_t k = 0; k < kColumns.size(); ++k) {
    if (!header.at.at(k) && k != kUse) missing.push_back(kColumns.at(k));
  }
  if (!missing.empty()) {
    where.fail(
        fmt::format("the header lacks {}; it must be a line like 'name,moving_x,moving_y,"
                    "moving_z,fixed_x,fixed_y,fixed_z,use' (use may be left out)",
                    fmt::join(missing, ", ")));
  }
  return header;
}

double coordinate(const std::string& text, std::string_view column, const Where& where) {
  if (text.empty()) where.fail(column, "no number; fill it in or remove the line");
  const auto value = io::parseNumber(text);
  if (!value) {
    where.fail(column, fmt::format("'{}' is no number; write metres with a decimal point and "
                                   "without a unit, like 432017.25",
                                   text));
  }
  if (!std::isfinite(*value)) {
    where.fail(column,
               fmt::format("'{}' is not finite; remove the line or pick the place again", text));
  }
  return *value;
}

PairUse useOf(const std::string& text, const Where& where) {
  const std::string word = lowered(text);
  if (word.empty() || word == "control") return PairUse::kControl;
  if (word == "check") return PairUse::kCheck;
  where.fail("use", fmt::format("'{}' is neither 'control' nor 'check'", text));
}

ControlPair pairOf(const std::vector<std::string>& fields, const Header& header,
                   const Where& where) {
  if (fields.size() != header.fields) {
    where.fail(
        fmt::format("{} fields where the header has {}; a decimal comma or a separator in a "
                    "name without quotes makes one too many",
                    fields.size(), header.fields));
  }
  const auto field = [&](std::size_t column) -> const std::string& {
    return fields.at(*header.at.at(column));
  };
  ControlPair pair;
  pair.name = field(kName);
  if (pair.name.empty()) where.fail("name", "no name; every pair needs one of its own");
  for (std::size_t k = 0; k < kCoordinates; ++k) {
    const double value = coordinate(field(k), kColumns.at(k), where);
    (k < 3 ? pair.moving : pair.fixed)[static_cast<Eigen::Index>(k % 3)] = value;
  }
  if (header.at.at(kUse)) pair.use = useOf(field(kUse), where);
  return pair;
}

}  // namespace

std::vector<ControlPair> readControlPairs(const std::filesystem::path& path) {
  const io::MappedFile file(path);
  std::string_view rest = file.text();
  Where where{path.string()};
  if (rest.size() > kMaxBytes) {
    throw InputError(fmt::format("{}: too long for a table of hand-picked pairs", where.file));
  }
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);  // byte order mark of spreadsheets
  std::optional<Header> header;
  std::vector<ControlPair> pairs;
  std::map<std::string, std::size_t> line_of;
  for (; !rest.empty(); ++where.line) {
    const std::string_view line = io::takeLine(rest);
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    if (!header) {
      header = headerOf(line, where);
      continue;
    }
    const std::vector<std::string> fields = fieldsOf(line, header->separator, where);
    // Spreadsheets write their empty rows as separators.
    if (std::all_of(fields.begin(), fields.end(), [](const auto& f) { return f.empty(); })) {
      continue;
    }
    pairs.push_back(pairOf(fields, *header, where));
    const auto [first, is_new] = line_of.emplace(pairs.back().name, where.line);
    if (!is_new) {
      where.fail("name", fmt::format("'{}' is the name of line {}, too; rename one of them",
                                     pairs.back().name, first->second));
    }
  }
  if (!header) {
    where.line = 1;
    where.fail("no header; the first line must name the columns (name, moving_x, ...)");
  }
  return pairs;
}

}  // namespace agricolmap::control_points
