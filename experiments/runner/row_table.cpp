#include "row_file.hpp"

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

/// `text` up to its last line end.
std::string_view wholeLines(std::string_view text) {
  return text.substr(0, text.find_last_of('\n') + 1);
}

std::string_view takeLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// `text` consists of whole lines.
RowLines split(std::string_view text, const std::filesystem::path& path, std::string_view header,
               std::string_view program) {
  const std::string_view first = takeLine(text);
  if (!first.starts_with("# ") || takeLine(text) != header) {
    throw InputError(
        fmt::format("{}: was not written by this version of {}; choose another --output",
                    path.string(), program));
  }
  RowLines lines;
  lines.identity = std::string(first.substr(2));
  while (!text.empty()) lines.rows.emplace_back(takeLine(text));
  return lines;
}

}  // namespace

RowLines readRowFile(const std::filesystem::path& path, std::string_view header,
                     std::string_view program) {
  const std::string text = slurp(path);
  return split(wholeLines(text), path, header, program);
}

std::string rowPlace(const std::filesystem::path& path, std::size_t row) {
  return fmt::format("{}:{}", path.string(), row + 3);
}

RowFile::RowFile(std::filesystem::path path, std::string_view header, std::string_view program,
                 std::string_view identity)
    : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) {
    throw OutputError(
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
  }
  try {
    if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
      throw OutputError(fmt::format("{}: another {} is writing it; choose another --output or wait",
                                    path_.string(), program));
    }
    const std::string text = slurp(path_);
    const std::string_view whole = wholeLines(text);
    if (whole.size() < text.size() && ::ftruncate(fd_, static_cast<off_t>(whole.size())) != 0) {
      throw OutputError(
          fmt::format("{}: cannot be repaired: {}", path_.string(), std::strerror(errno)));
    }
    if (whole.empty()) {
      append(fmt::format("# {}\n{}\n", identity, header));
      return;
    }
    RowLines there = split(whole, path_, header, program);
    if (there.identity != identity) {
      throw InputError(
          fmt::format("{}: its rows come from other code or options, and must not be mixed with "
                      "new ones\n  there: {}\n  now:   {}\nchoose another --output",
                      path_.string(), there.identity, identity));
    }
    rows_ = std::move(there.rows);
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

RowFile::~RowFile() { ::close(fd_); }

void RowFile::append(std::string_view line) {
  while (!line.empty()) {
    const ssize_t written = ::write(fd_, line.data(), line.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw OutputError(
          fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(errno)));
    }
    line.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace agricolmap::experiments
