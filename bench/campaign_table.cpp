#include "campaign_table.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text.hpp"

namespace agricolmap::campaign {
namespace {

constexpr std::string_view kHeader =
    "case,seed,field,preset,negative,status,accepted,success,correct,rms_m,rms_horizontal_m,"
    "rms_vertical_m,worst_m,rms_to_best_affine_m,e_t_m,e_r_rad,e_s,uniqueness,agreement,"
    "significance,overlap,correlation,blocks,block_rms_m,attempts,expected_rms_m,local_rms_m,"
    "height_deviation_m,probability,mahalanobis2,centre_mahalanobis2,height_mahalanobis2,fixed_"
    "points,moving_points,threads,simulate_s,total_s,stages,"
    "note";
constexpr std::size_t kColumns = 39;

using ErrorField = double RegistrationErrors::*;
constexpr std::array<ErrorField, 8> kErrorFields = {&RegistrationErrors::rms,
                                                    &RegistrationErrors::rms_horizontal,
                                                    &RegistrationErrors::rms_vertical,
                                                    &RegistrationErrors::worst,
                                                    &RegistrationErrors::rms_to_best_affine,
                                                    &RegistrationErrors::translation,
                                                    &RegistrationErrors::rotation,
                                                    &RegistrationErrors::scale};
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
    const auto value = parseNumber(field);
    if (!value) throw InputError(fmt::format("{}: '{}' is no number", place_, field));
    return *value;
  }
  std::int64_t whole() {
    const std::string_view field = fields_[next_++];
    const auto value = parseInteger(field);
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

std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

struct TableText {
  std::string identity;
  std::vector<PairRow> rows;
};

/// `text` consists of whole lines.
TableText parseTable(std::string_view text, const std::filesystem::path& path) {
  TableText table;
  const std::string_view first = takeLine(text);
  if (!first.starts_with("# ") || takeLine(text) != kHeader) {
    throw InputError(
        fmt::format("{}: was not written by this version of agricolmap_campaign; choose another "
                    "--output",
                    path.string()));
  }
  table.identity = std::string(first.substr(2));
  for (int line = 3; !text.empty(); ++line) {
    table.rows.push_back(parseLine(takeLine(text), fmt::format("{}:{}", path.string(), line)));
  }
  return table;
}

/// `text` up to its last line end.
std::string_view wholeLines(std::string_view text) {
  return text.substr(0, text.find_last_of('\n') + 1);
}

}  // namespace

RegistrationErrors noErrors() {
  RegistrationErrors errors;
  for (const ErrorField field : kErrorFields) {
    errors.*field = std::numeric_limits<double>::quiet_NaN();
  }
  return errors;
}

std::vector<PairRow> readPairs(const std::filesystem::path& path, std::string& identity) {
  const std::string text = slurp(path);
  TableText table = parseTable(wholeLines(text), path);
  identity = std::move(table.identity);
  return std::move(table.rows);
}

PairTable::PairTable(std::filesystem::path path, std::string_view identity)
    : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) {
    throw OutputError(
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  }
  try {
    if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      throw OutputError(fmt::format(
          "{}: another campaign is writing it; choose another --output or wait", path_.string()));
    }
    const std::string text = slurp(path_);
    const std::string_view whole = wholeLines(text);
    if (whole.size() < text.size() && ::ftruncate(fd_, static_cast<off_t>(whole.size())) != 0) {
      throw OutputError(
          fmt::format("{}: cannot be repaired: {}", path_.string(), std::strerror(errno)));
    }
    if (whole.empty()) {
      write(fmt::format("# {}\n{}\n", identity, kHeader));
      return;
    }
    TableText table = parseTable(whole, path_);
    if (table.identity != identity) {
      throw InputError(
          fmt::format("{}: its rows come from other code or options, and must not be mixed with "
                      "new ones\n  there: {}\n  now:   {}\nchoose another --output",
                      path_.string(), table.identity, identity));
    }
    rows_ = std::move(table.rows);
    for (const PairRow& row : rows_) keys_.insert({row.case_name, row.seed, row.preset});
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

PairTable::~PairTable() { ::close(fd_); }

void PairTable::append(const PairRow& row) {
  write(toLine(row));
  keys_.insert({row.case_name, row.seed, row.preset});
  rows_.push_back(row);
}

void PairTable::write(std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(fd_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw OutputError(
          fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
    }
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace agricolmap::campaign
