#include "runner/rows.hpp"

#include <fmt/format.h>

#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::experiments {
namespace {

constexpr std::string_view kProgram = "agricolmap_compare";
constexpr std::string_view kHeader =
    "dataset,kind,experiment,scale_error,setting,seed,method,status,accepted,correct,rms_m,"
    "rms_horizontal_m,rms_to_best_affine_m,e_t_m,e_r_rad,e_s,wall_s,run_s,cpu_s,peak_mib,idle_mib,"
    "matches,right,coherent,rematches,rematches_right,rematches_coherent,stages,note";
constexpr std::size_t kColumns = 29;

constexpr double evaluate::RegistrationErrors::*kErrors[] = {
    &evaluate::RegistrationErrors::rms,
    &evaluate::RegistrationErrors::rms_horizontal,
    &evaluate::RegistrationErrors::rms_to_best_affine,
    &evaluate::RegistrationErrors::translation,
    &evaluate::RegistrationErrors::rotation,
    &evaluate::RegistrationErrors::scale};
constexpr double Row::*kNumbers[] = {&Row::wall_s, &Row::run_s, &Row::cpu_s, &Row::peak_mib,
                                     &Row::idle_mib};
constexpr MatchCounts Row::*kMatchings[] = {&Row::first, &Row::last};
constexpr double MatchCounts::*kCounts[] = {&MatchCounts::matches, &MatchCounts::right,
                                            &MatchCounts::coherent};

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.7g}", value) : std::string();
}

/// Without what parts fields and lines.
std::string plain(std::string text) {
  for (char& c : text) {
    if (c == ',') c = ';';
    if (c == '\n' || c == '\r') c = ' ';
  }
  return text;
}

std::string toLine(const Row& row) {
  std::string line = fmt::format("{},{},{},{:.4g},{:.4g},{},{},{},{:d},{:d}", row.dataset, row.kind,
                                 row.experiment, row.scale, row.setting, row.seed, row.method,
                                 row.status, row.accepted, row.correct);
  for (const auto field : kErrors) line += fmt::format(",{}", number(row.errors.*field));
  for (const auto field : kNumbers) line += fmt::format(",{}", number(row.*field));
  for (const auto matching : kMatchings) {
    for (const auto field : kCounts) line += fmt::format(",{}", number(row.*matching.*field));
  }
  return line + fmt::format(",{},{}\n", plain(row.stages), plain(row.note));
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

double real(std::string_view field, const std::string& place) {
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto value = io::parseNumber(field);
  if (!value) throw InputError(fmt::format("{}: '{}' is no number", place, field));
  return *value;
}

Row parseLine(std::string_view line, const std::string& place) {
  const std::vector<std::string_view> fields = splitFields(line);
  if (fields.size() != kColumns) {
    throw InputError(fmt::format("{}: has {} fields, not {}; the file is damaged", place,
                                 fields.size(), kColumns));
  }
  Row row;
  std::size_t at = 0;
  const auto text = [&] { return std::string(fields[at++]); };
  const auto value = [&] { return real(fields[at++], place); };
  row.dataset = text();
  row.kind = text();
  row.experiment = text();
  row.scale = value();
  row.setting = value();
  row.seed = static_cast<int>(value());
  row.method = text();
  row.status = text();
  row.accepted = value() == 1.0;
  row.correct = value() == 1.0;
  for (const auto field : kErrors) row.errors.*field = value();
  for (const auto field : kNumbers) row.*field = value();
  for (const auto matching : kMatchings) {
    for (const auto field : kCounts) row.*matching.*field = value();
  }
  row.stages = text();
  row.note = text();
  return row;
}

std::vector<Row> parseRows(const std::vector<std::string>& lines,
                           const std::filesystem::path& path) {
  std::vector<Row> rows;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    rows.push_back(parseLine(lines[i], campaign::rowPlace(path, i)));
  }
  return rows;
}

}  // namespace

std::string Row::key() const {
  return fmt::format("{}|{}|{:.4g}|{:.4g}|{}|{}", dataset, experiment, scale, setting, seed,
                     method);
}

std::vector<Row> readRows(const std::filesystem::path& path, std::string& identity) {
  campaign::RowLines lines = campaign::readRowFile(path, kHeader, kProgram);
  identity = std::move(lines.identity);
  return parseRows(lines.rows, path);
}

RowTable::RowTable(const std::filesystem::path& path, std::string_view identity)
    : file_(path, kHeader, kProgram, identity), rows_(parseRows(file_.rows(), path)) {
  for (std::size_t i = 0; i < rows_.size(); ++i) places_[rows_[i].key()] = i;
}

const Row* RowTable::find(const std::string& key) const {
  const auto at = places_.find(key);
  return at == places_.end() ? nullptr : &rows_[at->second];
}

void RowTable::append(const Row& row) {
  file_.append(toLine(row));
  places_[row.key()] = rows_.size();
  rows_.push_back(row);
}

}  // namespace agricolmap::experiments
