#include "experiments/runner/row.hpp"

#include <fmt/format.h>

#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::experiments {
namespace {

template <typename... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};
template <typename... Handlers>
Overloaded(Handlers...) -> Overloaded<Handlers...>;

/// Without what parts fields and lines.
std::string plain(std::string text) {
  for (char& c : text) {
    if (c == ',') c = ';';
    if (c == '"') c = '\'';
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

std::string fieldOf(const Row& row, const Column& column) {
  return std::visit(
      Overloaded{[&](std::string Row::*text) { return plain(row.*text); },
                 [&](int Row::*whole) { return fmt::format("{}", row.*whole); },
                 [&](bool Row::*flag) { return std::string(row.*flag ? "1" : "0"); },
                 [&](double Row::*number) {
                   return std::isfinite(row.*number) ? fmt::format("{:.9g}", row.*number) : "";
                 }},
      column.member);
}

double numberFrom(std::string_view field, const std::string& place) {
  if (field.empty()) return kNotKnown;
  const auto value = io::parseNumber(field);
  if (!value) throw InputError(fmt::format("{}: '{}' is no number", place, field));
  return *value;
}

std::int64_t wholeFrom(std::string_view field, const std::string& place) {
  const auto value = io::parseInteger(field);
  if (!value) throw InputError(fmt::format("{}: '{}' is no whole number", place, field));
  return *value;
}

void setField(Row& row, const Column& column, std::string_view field, const std::string& place) {
  std::visit(
      Overloaded{[&](std::string Row::*text) { row.*text = std::string(field); },
                 [&](int Row::*whole) { row.*whole = static_cast<int>(wholeFrom(field, place)); },
                 [&](bool Row::*flag) { row.*flag = wholeFrom(field, place) != 0; },
                 [&](double Row::*number) { row.*number = numberFrom(field, place); }},
      column.member);
}

std::vector<std::string_view> splitFields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    fields.push_back(line.substr(begin, comma - begin));
    if (comma == std::string_view::npos) return fields;
    begin = comma + 1;
  }
}

/// What was run, and how it ended.
std::vector<Column> columnsOfTheRun() {
  return {{"suite", &Row::suite},
          {"settings", &Row::settings},
          {"case_name", &Row::case_name},
          {"dataset", &Row::dataset},
          {"kind", &Row::kind},
          {"seed", &Row::seed},
          {"setting", &Row::setting},
          {"guess_scale", &Row::guess_scale},
          {"field", &Row::field},
          {"negative", &Row::negative},
          {"guess_translation", &Row::guess_translation},
          {"guess_heading", &Row::guess_heading},
          {"told", &Row::told},
          {"method", &Row::method},
          {"threads", &Row::threads},
          {"status", &Row::status},
          {"accepted", &Row::accepted},
          {"right", &Row::right},
          {"right_in_plane", &Row::right_in_plane}};
}

/// What came out, and what it took.
std::vector<Column> columnsOfTheAnswer() {
  return {{"rms", &Row::rms},
          {"rms_horizontal", &Row::rms_horizontal},
          {"rms_vertical", &Row::rms_vertical},
          {"aligned_rms", &Row::aligned_rms},
          {"aligned_rms_horizontal", &Row::aligned_rms_horizontal},
          {"best_affine_rms", &Row::best_affine_rms},
          {"worst", &Row::worst},
          {"rms_to_best_affine", &Row::rms_to_best_affine},
          {"e_t", &Row::e_t},
          {"e_r", &Row::e_r},
          {"e_s", &Row::e_s},
          {"bend_gain", &Row::bend_gain},
          {"slips", &Row::slips},
          {"slip_place", &Row::slip_place},
          {"places_covered", &Row::places_covered},
          {"plane_probability", &Row::plane_probability},
          {"place_probability", &Row::place_probability},
          {"uniqueness", &Row::uniqueness},
          {"significance", &Row::significance},
          {"decoy", &Row::decoy},
          {"agreeing", &Row::agreeing},
          {"blocks", &Row::blocks},
          {"expected_rms", &Row::expected_rms},
          {"systematic_rms", &Row::systematic_rms},
          {"scatter_rms", &Row::scatter_rms},
          {"local_rms", &Row::local_rms},
          {"height_deviation", &Row::height_deviation},
          {"heights_limited", &Row::heights_limited},
          {"overlap", &Row::overlap},
          {"block_rms", &Row::block_rms},
          {"correlation", &Row::correlation},
          {"attempts", &Row::attempts},
          {"pose_mahalanobis2", &Row::pose_mahalanobis2},
          {"centre_mahalanobis2", &Row::centre_mahalanobis2},
          {"height_mahalanobis2", &Row::height_mahalanobis2},
          {"centre_error_x", &Row::centre_error_x},
          {"centre_error_y", &Row::centre_error_y},
          {"centre_deviation_x", &Row::centre_deviation_x},
          {"centre_deviation_y", &Row::centre_deviation_y},
          {"centre_correlation", &Row::centre_correlation},
          {"height_error", &Row::height_error},
          {"matches", &Row::matches},
          {"matches_right", &Row::matches_right},
          {"matches_coherent", &Row::matches_coherent},
          {"rematches", &Row::rematches},
          {"rematches_right", &Row::rematches_right},
          {"rematches_coherent", &Row::rematches_coherent},
          {"fixed_points", &Row::fixed_points},
          {"moving_points", &Row::moving_points},
          {"make_s", &Row::make_s},
          {"run_s", &Row::run_s},
          {"cpu_s", &Row::cpu_s},
          {"stages", &Row::stages},
          {"message", &Row::message},
          {"source", &Row::source},
          {"options", &Row::options}};
}

}  // namespace

const std::vector<Column>& columns() {
  // In the order of the members.
  static const std::vector<Column> all = [] {
    std::vector<Column> columns = columnsOfTheRun();
    const std::vector<Column> more = columnsOfTheAnswer();
    columns.insert(columns.end(), more.begin(), more.end());
    return columns;
  }();
  return all;
}

std::string Row::key() const {
  return fmt::format("{}|{}|{}|{}|{:.4g}|{:.4g}|{}", suite, settings, case_name, seed, setting,
                     guess_scale, method);
}

double Row::*numberColumn(std::string_view name) {
  for (const Column& column : columns()) {
    if (column.name != name) continue;
    if (const auto* number = std::get_if<double Row::*>(&column.member)) return *number;
  }
  throw Error(ErrorKind::kInternal, fmt::format("no number of a row is called '{}'", name));
}

std::string csvHeader() {
  std::string line;
  for (const Column& column : columns()) {
    line += fmt::format("{}{}", line.empty() ? "" : ",", column.name);
  }
  return line;
}

std::string toCsv(const Row& row) {
  std::string line;
  for (const Column& column : columns()) line += fieldOf(row, column) + ',';
  line.back() = '\n';
  return line;
}

Row rowFromCsv(std::string_view line, const std::string& place) {
  const std::vector<std::string_view> fields = splitFields(line);
  if (fields.size() != columns().size()) {
    throw InputError(fmt::format("{}: has {} fields, not {}; the file is damaged", place,
                                 fields.size(), columns().size()));
  }
  Row row;
  for (std::size_t i = 0; i < fields.size(); ++i) setField(row, columns()[i], fields[i], place);
  return row;
}

}  // namespace agricolmap::experiments
