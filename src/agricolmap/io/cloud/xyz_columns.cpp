#include "agricolmap/io/cloud/xyz_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/commas.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

using Use = AsciiColumn::Use;

constexpr std::size_t kMostHeadLines = 100;
constexpr std::size_t kSampledLines = 500;
constexpr const char* kRemedy =
    "name the columns in a first line, as 'x y z r g b' or 'x y z nx ny nz'";

/// How a line keeps its values apart.
struct Form {
  char separator = ' ';
  bool decimal_comma = false;
  bool either = false;  ///< commas may be both

  std::vector<std::string_view> split(std::string_view line) const {
    if (separator == ' ') return splitWords(line);
    std::vector<std::string_view> fields;
    while (!line.empty()) fields.push_back(takeField(line, separator));
    while (!fields.empty() && fields.back().empty()) fields.pop_back();
    return fields;
  }
  std::optional<double> number(std::string_view word) const {
    return decimal_comma ? parseCommaNumber(word) : parseNumber(word);
  }
};

Form formOf(std::string_view line) {
  const CommaUse commas = commaUseOf(line);
  Form form;
  form.either = commas == CommaUse::kEither;
  if (line.find(';') != std::string_view::npos) {
    form.separator = ';';
    form.decimal_comma = commas == CommaUse::kDecimal;
  } else if (!form.either && line.find(',') != std::string_view::npos) {
    form.separator = ',';
  }
  form.decimal_comma = form.decimal_comma || form.either;
  return form;
}

bool beginsWithNumbers(const Form& form, const std::vector<std::string_view>& fields) {
  if (fields.size() < 3) return false;
  return std::all_of(fields.begin(), fields.begin() + 3,
                     [&](std::string_view field) { return form.number(field).has_value(); });
}

/// The lines before the points, and the form of the first of these.
struct Head {
  std::size_t begin = 0;
  char line_end = '\n';
  Form form;
  std::size_t columns = 0;
  std::vector<std::string_view> names;  ///< fields of the last line before the points, if any
  bool comment = false;                 ///< that line is one
  std::vector<std::uint64_t> counts;    ///< lines of one whole number
};

std::string_view withoutCommentMark(std::string_view line, bool& comment) {
  const std::size_t first = line.find_first_not_of(" \t");
  line.remove_prefix(std::min(first, line.size()));
  const std::size_t mark = std::min(line.find_first_not_of("/#%!"), line.size());
  comment = mark > 0;
  return line.substr(mark);
}

/// Nothing where no line of numbers comes soon.
std::optional<Head> headOf(std::string_view text) {
  Head head;
  head.line_end = lineEndOf(text);
  std::string_view rest = text;
  for (std::size_t i = 0; i < kMostHeadLines && !rest.empty(); ++i) {
    const auto begin = static_cast<std::size_t>(rest.data() - text.data());
    bool comment = false;
    const std::string_view line = withoutCommentMark(takeLine(rest, head.line_end), comment);
    if (line.find('\0') != std::string_view::npos) return std::nullopt;
    const Form form = formOf(line);
    const std::vector<std::string_view> fields = form.split(line);
    if (fields.empty()) continue;
    if (!comment && beginsWithNumbers(form, fields)) {
      head.begin = begin;
      head.form = form;
      head.columns = fields.size();
      return head;
    }
    const auto count = fields.size() == 1 ? parseInteger(fields[0]) : std::nullopt;
    if (count && *count >= 0) {
      head.counts.push_back(static_cast<std::uint64_t>(*count));
    } else {
      head.names = fields;
      head.comment = comment;
    }
  }
  return std::nullopt;
}

/// "Easting [m]" is easting.
std::string plainName(std::string_view field) {
  std::string name = lowerCase(field);
  name.erase(std::min(name.find_first_of("[("), name.size()));
  name.erase(std::remove_if(name.begin(), name.end(),
                            [](char c) { return c == '"' || c == '\'' || isBlank(c); }),
             name.end());
  return name;
}

Use useOf(const std::string& name) {
  struct Named {
    Use use;
    std::array<std::string_view, 5> names;
  };
  static constexpr std::array<Named, 6> kNames{{{Use::kX, {"x", "easting", "east"}},
                                                {Use::kY, {"y", "northing", "north"}},
                                                {Use::kZ, {"z", "height", "elevation", "altitude"}},
                                                {Use::kRed, {"r", "red", "rf"}},
                                                {Use::kGreen, {"g", "green", "gf"}},
                                                {Use::kBlue, {"b", "blue", "bf"}}}};
  for (const Named& named : kNames) {
    if (!name.empty() &&
        std::find(named.names.begin(), named.names.end(), name) != named.names.end()) {
      return named.use;
    }
  }
  return Use::kSkip;
}

[[noreturn]] void fail(const std::string& name, const std::string& what) {
  throw InputError(fmt::format("{}: {}", name, what));
}

std::size_t countOf(const std::vector<AsciiColumn>& columns, Use use) {
  return static_cast<std::size_t>(std::count_if(
      columns.begin(), columns.end(), [&](const AsciiColumn& c) { return c.use == use; }));
}

/// By names; empty where the line before the points is none of names.
std::vector<AsciiColumn> byNames(const Head& head, const std::string& name) {
  if (head.names.size() != head.columns) return {};
  std::vector<AsciiColumn> columns;
  std::string listed;
  for (const std::string_view field : head.names) {
    const std::string plain = plainName(field);
    if (plain.starts_with("lon") || plain.starts_with("lat")) {
      fail(name, fmt::format("its column '{}' is in degrees; bring the points into a projected "
                             "coordinate system (UTM)",
                             plain));
    }
    columns.push_back({useOf(plain)});
    listed += (listed.empty() ? "" : ", ") + plain;
  }
  constexpr std::array kAxes{Use::kX, Use::kY, Use::kZ};
  const bool all =
      std::all_of(kAxes.begin(), kAxes.end(), [&](Use use) { return countOf(columns, use) == 1; });
  if (!all && head.comment) return {};
  if (!all) {
    fail(name, fmt::format("its columns are named {}; one each of x, y and z is needed", listed));
  }
  for (const Use use : {Use::kRed, Use::kGreen, Use::kBlue}) {
    if (countOf(columns, use) > 1) {
      fail(name, fmt::format("its columns are named {}: a colour is there twice", listed));
    }
  }
  return columns;
}

/// Values of the first lines with points.
std::vector<std::vector<double>> sampleOf(std::string_view text, const Head& head) {
  std::vector<std::vector<double>> rows;
  while (!text.empty() && rows.size() < kSampledLines) {
    std::vector<double> row;
    for (const std::string_view field : head.form.split(takeLine(text, head.line_end))) {
      row.push_back(head.form.number(field).value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    if (row.size() == head.columns) rows.push_back(std::move(row));
  }
  return rows;
}

/// Whether three columns from `first` on can be colours: whole numbers that are none below zero, or
/// 0 to 1 without being the unit vectors that normals are.
bool canBeColours(const std::vector<std::vector<double>>& rows, std::size_t first) {
  constexpr double kMost = 65535.0;
  constexpr double kUnitTolerance = 0.01;
  bool whole = true;
  bool shares = true;
  bool units = true;
  for (const std::vector<double>& row : rows) {
    if (row.size() < first + 3) return false;
    double square = 0.0;
    for (std::size_t c = first; c < first + 3; ++c) {
      const double value = row[c];
      if (std::isnan(value)) continue;  // of a point that is none
      whole = whole && value == std::floor(value) && value >= 0.0 && value <= kMost;
      shares = shares && value >= -kUnitTolerance && value <= 1.0 + kUnitTolerance;
      square += value * value;
    }
    units = units && std::abs(square - 1.0) < kUnitTolerance;
  }
  return whole || (shares && !units);
}

std::vector<AsciiColumn> byPlace(const Head& head, std::string_view text, const std::string& name) {
  constexpr std::size_t kNoColours = 5;  // x y z and, say, an intensity
  std::vector<AsciiColumn> columns{{Use::kX}, {Use::kY}, {Use::kZ}};
  columns.resize(head.columns);
  if (head.columns <= kNoColours) return columns;
  const auto rows = sampleOf(text, head);
  const bool third = canBeColours(rows, 3);
  const bool fourth = head.columns > 6 && canBeColours(rows, 4);
  const bool pts = !head.counts.empty() && head.columns == 7;  // x y z intensity r g b
  if (!third && !fourth) {
    fail(name,
         fmt::format("what its {} columns are is not said, and neither the 4th to 6th nor the "
                     "5th to 7th can be colours; {}",
                     head.columns, kRemedy));
  }
  if (third && fourth && !pts) {
    fail(name, fmt::format("what its {} columns are is not said, and colours may be the 4th to 6th "
                           "as well as the 5th to 7th; {}",
                           head.columns, kRemedy));
  }
  const std::size_t first = fourth && (pts || !third) ? 4 : 3;
  columns[first].use = Use::kRed;
  columns[first + 1].use = Use::kGreen;
  columns[first + 2].use = Use::kBlue;
  return columns;
}

std::string fieldsOf(const Head& head, const std::vector<AsciiColumn>& columns) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    static constexpr std::array<std::string_view, 9> kNames{"", "", "x", "y", "z", "r", "g", "b"};
    std::string name(kNames[static_cast<std::size_t>(columns[i].use)]);
    if (name.empty() && head.names.size() == columns.size()) name = plainName(head.names[i]);
    names.push_back(name.empty() ? "?" : name);
  }
  return fieldList(names);
}

}  // namespace

bool looksLikeXyz(std::string_view text) { return headOf(text).has_value(); }

XyzColumns xyzColumns(std::string_view text, const std::string& name) {
  const auto head = headOf(text);
  if (!head) fail(name, "has no lines of three or more numbers");
  if (head->counts.size() > 1) {
    fail(name, "it is PTX, whose scans have poses of their own; write it as LAS, PLY or PTS");
  }
  if (head->form.either) {
    fail(name, std::string(kAmbiguousCommas));
  }
  XyzColumns found;
  found.begin = head->begin;
  found.line_end = head->line_end;
  found.separator = head->form.separator;
  found.decimal_comma = head->form.decimal_comma;
  found.columns = byNames(*head, name);
  if (found.columns.empty()) found.columns = byPlace(*head, text.substr(head->begin), name);
  const std::size_t colours = countOf(found.columns, Use::kRed) +
                              countOf(found.columns, Use::kGreen) +
                              countOf(found.columns, Use::kBlue);
  found.colours = colours == 3;
  if (!found.colours) {
    for (AsciiColumn& column : found.columns) {
      if (column.use >= Use::kRed) column.use = Use::kSkip;
    }
  }
  found.fields = fieldsOf(*head, found.columns);
  if (!head->counts.empty() && head->counts.front() > 0) found.announced = head->counts.front();
  return found;
}

}  // namespace agricolmap::io
