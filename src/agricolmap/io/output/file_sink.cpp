#include "agricolmap/io/output/file_sink.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {

FileSink::FileSink(OutputPath path)
    : path_(std::move(path)),
      fd_(::open(path_.file().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)) {
  if (fd_ < 0) fail("cannot be created");
}

FileSink::~FileSink() {
  if (fd_ >= 0) ::close(fd_);
}

void FileSink::fail(std::string_view what) const {
  throw OutputError(fmt::format("{}: {}: {}", path_.shown(), what, std::strerror(errno)));
}

void FileSink::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(fd_, bytes.data(), bytes.size());
    if (written < 0) {
      if (errno == EINTR) continue;
      fail("cannot be written");
    }
    size_ += static_cast<std::size_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void FileSink::write(std::string_view text) { write(std::as_bytes(std::span(text))); }

void FileSink::rewrite(std::size_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0) {
      if (errno == EINTR) continue;
      fail(errno == ESPIPE ? "is a pipe, which this format cannot be written to"
                           : "cannot be written");
    }
    offset += static_cast<std::size_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void FileSink::close() {
  const int fd = std::exchange(fd_, -1);
  if (fd >= 0 && ::close(fd) != 0) fail("cannot be written");
}

void writeText(const OutputPath& path, std::string_view text) {
  FileSink sink(path);
  sink.write(text);
  sink.close();
}

}  // namespace agricolmap::io
