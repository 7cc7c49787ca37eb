#include "agricolmap/io/output/scratch_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {

ScratchFile::ScratchFile(const OutputPath& beside) : shown_(beside.shown()) {
  std::string name = (beside.file().parent_path() / ".agricolmap-XXXXXX").string();
  fd_ = ::mkstemp(name.data());
  if (fd_ < 0) fail("a temporary file cannot be made beside it");
  ::unlink(name.c_str());
}

ScratchFile::~ScratchFile() { ::close(fd_); }

void ScratchFile::fail(const char* what) const {
  throw OutputError(fmt::format("{}: {}: {}", shown_, what, std::strerror(errno)));
}

void ScratchFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("its temporary file cannot be written");
    offset += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

void ScratchFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  while (!bytes.empty()) {
    const ssize_t done = ::pread(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("its temporary file cannot be read");
    offset += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
}

}  // namespace agricolmap::io
