#include "runner/rows.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text.hpp"

namespace agricolmap::compare {
namespace {

constexpr std::string_view kHeader =
    "dataset,kind,experiment,scale_error,setting,seed,method,status,accepted,correct,rms_m,"
    "rms_horizontal_m,rms_to_best_affine_m,e_t_m,e_r_rad,e_s,wall_s,run_s,cpu_s,peak_mib,idle_mib,"
    "matches,right,coherent,stages,note";
constexpr std::size_t kColumns = 26;

constexpr double RegistrationErrors::*kErrors[] = {&RegistrationErrors::rms,
                                                   &RegistrationErrors::rms_horizontal,
                                                   &RegistrationErrors::rms_to_best_affine,
                                                   &RegistrationErrors::translation,
                                                   &RegistrationErrors::rotation,
                                                   &RegistrationErrors::scale};
constexpr double Row::*kNumbers[] = {&Row::wall_s,   &Row::run_s,   &Row::cpu_s, &Row::peak_mib,
                                     &Row::idle_mib, &Row::matches, &Row::right, &Row::coherent};

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
  const auto value = parseNumber(field);
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
  row.stages = text();
  row.note = text();
  return row;
}

std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

/// `text` consists of whole lines.
std::vector<Row> parseTable(std::string_view text, const std::filesystem::path& path,
                            std::string& identity) {
  const auto takeLine = [&] {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    return line;
  };
  const std::string_view first = takeLine();
  if (!first.starts_with("# ") || takeLine() != kHeader) {
    throw InputError(fmt::format(
        "{}: was not written by this version of agricolmap_compare; choose another --output",
        path.string()));
  }
  identity = std::string(first.substr(2));
  std::vector<Row> rows;
  for (int line = 3; !text.empty(); ++line) {
    rows.push_back(parseLine(takeLine(), fmt::format("{}:{}", path.string(), line)));
  }
  return rows;
}

std::string_view wholeLines(std::string_view text) {
  return text.substr(0, text.find_last_of('\n') + 1);
}

}  // namespace

std::string Row::key() const {
  return fmt::format("{}|{}|{:.4g}|{:.4g}|{}|{}", dataset, experiment, scale, setting, seed,
                     method);
}

std::vector<Row> readRows(const std::filesystem::path& path, std::string& identity) {
  const std::string text = slurp(path);
  return parseTable(wholeLines(text), path, identity);
}

RowTable::RowTable(std::filesystem::path path, std::string_view identity) : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) {
    throw OutputError(
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  }
  try {
    if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      throw OutputError(fmt::format(
          "{}: another comparison is writing it; choose another --output or wait", path_.string()));
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
    std::string there;
    rows_ = parseTable(whole, path_, there);
    if (there != identity) {
      throw InputError(
          fmt::format("{}: its rows come from other code or options, and must not be mixed with "
                      "new ones\n  there: {}\n  now:   {}\nchoose another --output",
                      path_.string(), there, identity));
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) places_[rows_[i].key()] = i;
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

RowTable::~RowTable() { ::close(fd_); }

const Row* RowTable::find(const std::string& key) const {
  const auto at = places_.find(key);
  return at == places_.end() ? nullptr : &rows_[at->second];
}

void RowTable::append(const Row& row) {
  write(toLine(row));
  places_[row.key()] = rows_.size();
  rows_.push_back(row);
}

void RowTable::write(std::string_view text) {
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

}  // namespace agricolmap::compare
