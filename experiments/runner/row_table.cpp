#include "experiments/runner/row_table.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "agricolmap/core/error.hpp"

namespace agricolmap::experiments {
namespace {

std::string slurp(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw InputError(fmt::format("{}: cannot be read", path.string()));
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string_view takeLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  return line;
}

[[noreturn]] void cannotWrite(const std::filesystem::path& path) {
  throw OutputError(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
}

}  // namespace

RowTable::RowTable(std::filesystem::path path, std::string_view source) : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) cannotWrite(path_);
  try {
    load(source);
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

RowTable::~RowTable() { ::close(fd_); }

void RowTable::load(std::string_view source) {
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
    throw OutputError(
        fmt::format("{}: another process is writing it; choose another --output or "
                    "wait",
                    path_.string()));
  }
  const std::string text = slurp(path_);
  std::string_view whole = std::string_view(text).substr(0, text.find_last_of('\n') + 1);
  if (whole.size() < text.size() && ::ftruncate(fd_, static_cast<off_t>(whole.size())) != 0) {
    cannotWrite(path_);
  }
  if (whole.empty()) {
    write(csvHeader() + '\n');
    return;
  }
  if (takeLine(whole) != csvHeader()) {
    throw InputError(
        fmt::format("{}: has other columns than this version writes; choose another "
                    "--output",
                    path_.string()));
  }
  for (int line = 2; !whole.empty(); ++line) {
    Row row = rowFromCsv(takeLine(whole), fmt::format("{}:{}", path_.string(), line));
    if (row.source != source) {
      throw InputError(
          fmt::format("{}:{}: comes from other sources ({}) than this program ({}), and must not "
                      "be mixed with new rows; choose another --output",
                      path_.string(), line, row.source, source));
    }
    places_[row.key()] = rows_.size();
    rows_.push_back(std::move(row));
  }
}

const Row* RowTable::find(const std::string& key) const {
  const auto at = places_.find(key);
  return at == places_.end() ? nullptr : &rows_[at->second];
}

void RowTable::append(const Row& row) {
  write(toCsv(row));
  places_[row.key()] = rows_.size();
  rows_.push_back(row);
}

void RowTable::write(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t written = ::write(fd_, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) cannotWrite(path_);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace agricolmap::experiments
