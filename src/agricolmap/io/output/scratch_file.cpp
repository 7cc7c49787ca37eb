#include "agricolmap/io/output/scratch_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

/// Opened for reading and writing, and gone from its folder; below 0 where that cannot be.
int openUnnamed(const std::filesystem::path& folder) {
  const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (fd >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return fd;
  // File systems that know no files without a name.
  std::string name = folder / ".agricolmap-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

/// `move` is pread or pwrite. Returns 0, or why it failed.
template <typename Byte, typename Move>
int moveBytes(int fd, std::span<Byte> bytes, std::uint64_t offset, const Move& move) {
  while (!bytes.empty()) {
    const ssize_t done = move(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return done < 0 ? errno : EIO;
    offset += static_cast<std::uint64_t>(done);
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return 0;
}

}  // namespace

std::string scratchFolder() {
  const char* const named = std::getenv("TMPDIR");
  return named == nullptr || *named == '\0' ? "/var/tmp" : named;
}

ScratchFile::ScratchFile(const std::filesystem::path& folder, std::string purpose,
                         std::string remedy)
    : purpose_(std::move(purpose)),
      remedy_(std::move(remedy)),
      fd_(openUnnamed(folder.empty() ? "." : folder)) {
  if (fd_ < 0) fail(errno);
}

ScratchFile::~ScratchFile() { ::close(fd_); }

void ScratchFile::fail(int error) const {
  throw OutputError(fmt::format("{}: {}{}", purpose_, std::strerror(error),
                                remedy_.empty() ? "" : "; " + remedy_));
}

void ScratchFile::reserve(std::uint64_t bytes) {
  if (bytes == 0 || ::fallocate(fd_, 0, 0, static_cast<off_t>(bytes)) == 0) return;
  if (errno != EOPNOTSUPP && errno != ENOSYS) fail(errno);
}

void ScratchFile::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  if (const int error = moveBytes(fd_, bytes, offset, ::pwrite)) fail(error);
}

void ScratchFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  if (const int error = moveBytes(fd_, bytes, offset, ::pread)) fail(error);
}

}  // namespace agricolmap::io
