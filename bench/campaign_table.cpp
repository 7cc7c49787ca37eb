#include "campaign_table.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::campaign {
namespace {

constexpr std::string_view kProgram = "agricolmap_campaign";
constexpr std::string_view kHeader =
    "case,seed,field,preset,negative,status,accepted,success,correct,rms_m,rms_horizontal_m,"
    "rms_vertical_m,worst_m,rms_to_best_affine_m,e_t_m,e_r_rad,e_s,uniqueness,agreement,"
    "significance,overlap,correlation,blocks,block_rms_m,attempts,expected_rms_m,local_rms_m,"
    "height_deviation_m,probability,mahalanobis2,centre_mahalanobis2,height_mahalanobis2,fixed_"
    "points,moving_points,threads,simulate_s,total_s,stages,"
    "note";
constexpr std::size_t kColumns = 39;

using ErrorField = double evaluate::RegistrationErrors::*;
constexpr std::array<ErrorField, 8> kErrorFields = {
    &evaluate::RegistrationErrors::rms,
    &evaluate::RegistrationErrors::rms_horizontal,
    &evaluate::RegistrationErrors::rms_vertical,
    &evaluate::RegistrationErrors::worst,
    &evaluate::RegistrationErrors::rms_to_best_affine,
    &evaluate::RegistrationErrors::translation,
    &evaluate::RegistrationErrors::rotation,
    &evaluate::RegistrationErrors::scale};
using EvidenceField = double PairRow::*;
constexpr std::array<EvidenceField, 15> kEvidenceFields = {
    &PairRow::uniqueness,         &PairRow::agreement,
    &PairRow::significance,       &PairRow::overlap,
    &PairRow::correlation,        &PairRow::blocks,
    &PairRow::block_rms,          &PairRow::attempts,
    &PairRow::expected_rms,       &PairRow::local_rms,
    &PairRow::height_deviation,   &PairRow::probability,
    &PairRow::mahalanobis2,       &PairRow::centre_mahalanobis2,
    &PairRow::height_mahalanobis2};

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string();
}

/// Free text as one field.
std::string plain(std::string text) {
  for (char& c : text) {
    if (c == ',' || c == '\n' || c == '\r' || c == '"') c = ' ';
  }
  return text;
}

std::string toLine(const PairRow& row) {
  std::string line = fmt::format("{},{},{},{},{:d},{},{:d},{:d},{:d}", row.case_name, row.seed,
                                 row.field, row.preset, row.negative, plain(row.status),
                                 row.accepted, row.success(), row.correct);
  for (const ErrorField field : kErrorFields) line += fmt::format(",{}", number(row.errors.*field));
  for (const EvidenceField field : kEvidenceFields) line += fmt::format(",{}", number(row.*field));
  line += fmt::format(",{},{},{},{:.4f},{:.4f},{},{}\n", row.fixed_points, row.moving_points,
                      row.threads, row.simulate_s, row.total_s, plain(row.stages), plain(row.note));
  return line;
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

/// Takes the fields of one line in order.
class LineReader {
 public:
  LineReader(std::string_view line, std::string place)
      : fields_(splitFields(line)), place_(std::move(place)) {
    if (fields_.size() != kColumns) {
      throw InputError(fmt::format("{}: has {} fields, not {}; the file is damaged", place_,
                                   fields_.size(), kColumns));
    }
  }
  std::string text() { return std::string(fields_[next_++]); }
  double real() {
    const std::string_view field = fields_[next_++];
    if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto value = io::parseNumber(field);
    if (!value) throw InputError(fmt::format("{}: '{}' is no number", place_, field));
    return *value;
  }
  std::int64_t whole() {
    const std::string_view field = fields_[next_++];
    const auto value = io::parseInteger(field);
    if (!value) throw InputError(fmt::format("{}: '{}' is no whole number", place_, field));
    return *value;
  }
  bool flag() { return whole() != 0; }

 private:
  std::vector<std::string_view> fields_;
  std::string place_;
  std::size_t next_ = 0;
};

PairRow parseLine(std::string_view line, std::string place) {
  LineReader reader(line, std::move(place));
  PairRow row;
  row.case_name = reader.text();
  row.seed = static_cast<int>(reader.whole());
  row.field = static_cast<int>(reader.whole());
  row.preset = reader.text();
  row.negative = reader.flag();
  row.status = reader.text();
  row.accepted = reader.flag();
  reader.flag();  // success follows from the two beside it
  row.correct = reader.flag();
  for (const ErrorField field : kErrorFields) row.errors.*field = reader.real();
  for (const EvidenceField field : kEvidenceFields) row.*field = reader.real();
  row.fixed_points = static_cast<std::size_t>(reader.whole());
  row.moving_points = static_cast<std::size_t>(reader.whole());
  row.threads = static_cast<int>(reader.whole());
  row.simulate_s = reader.real();
  row.total_s = reader.real();
  row.stages = reader.text();
  row.note = reader.text();
  return row;
}

std::vector<PairRow> parseRows(const std::vector<std::string>& lines,
                               const std::filesystem::path& path) {
  std::vector<PairRow> rows;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    rows.push_back(parseLine(lines[i], rowPlace(path, i)));
  }
  return rows;
}

}  // namespace

evaluate::RegistrationErrors noErrors() {
  evaluate::RegistrationErrors errors;
  for (const ErrorField field : kErrorFields) {
    errors.*field = std::numeric_limits<double>::quiet_NaN();
  }
  return errors;
}

std::vector<PairRow> readPairs(const std::filesystem::path& path, std::string& identity) {
  RowLines lines = readRowFile(path, kHeader, kProgram);
  identity = std::move(lines.identity);
  return parseRows(lines.rows, path);
}

PairTable::PairTable(const std::filesystem::path& path, std::string_view identity)
    : file_(path, kHeader, kProgram, identity), rows_(parseRows(file_.rows(), path)) {
  for (const PairRow& row : rows_) keys_.insert({row.case_name, row.seed, row.preset});
}

void PairTable::append(const PairRow& row) {
  file_.append(toLine(row));
  keys_.insert({row.case_name, row.seed, row.preset});
  rows_.push_back(row);
}

}  // namespace agricolmap::campaign
