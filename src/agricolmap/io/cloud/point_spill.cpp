#include "agricolmap/io/cloud/point_spill.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

std::string temporaryFolder() {
  const char* const named = std::getenv("TMPDIR");
  return named == nullptr || *named == '\0' ? "/var/tmp" : named;
}

/// Opened for reading and writing, and gone from its folder; below 0 where that cannot be.
int openUnnamed(const std::string& folder) {
  const int fd = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (fd >= 0 || (errno != EOPNOTSUPP && errno != EISDIR)) return fd;
  // File systems that know no files without a name.
  std::string name = folder + "/agricolmap-XXXXXX";
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

/// `move` is pread or pwrite; false with errno set when it fails, 0 when it comes to an end.
template <typename Byte, typename Move>
bool moveAll(int fd, Byte* bytes, std::size_t count, std::size_t at, const Move& move) {
  while (count > 0) {
    const ssize_t done = move(fd, bytes, count, static_cast<off_t>(at));
    if (done < 0 && errno == EINTR) continue;
    if (done == 0) errno = EIO;
    if (done <= 0) return false;
    bytes += done;
    count -= static_cast<std::size_t>(done);
    at += static_cast<std::size_t>(done);
  }
  return true;
}

}  // namespace

PointSpill::PointSpill(std::size_t points, bool coloured, const std::string& source)
    : points_(points), source_(source), folder_(temporaryFolder()), fd_(openUnnamed(folder_)) {
  if (fd_ < 0) failToWrite();
  const std::size_t bytes = points * (sizeof(Eigen::Vector3f) + (coloured ? sizeof(Rgb) : 0));
  // Known now rather than at the last point; file systems that cannot promise are believed.
  if (bytes > 0 && ::fallocate(fd_, 0, 0, static_cast<off_t>(bytes)) != 0 && errno != EOPNOTSUPP &&
      errno != ENOSYS) {
    const int error = errno;
    ::close(fd_);
    errno = error;
    failToWrite();
  }
}

PointSpill::~PointSpill() { ::close(fd_); }

void PointSpill::failToWrite() const {
  throw OutputError(fmt::format(
      "{}: its decoded points need {:.1f} GiB for a while in {}: {}; name another folder in "
      "TMPDIR, "
      "or convert the file to LAS, which needs no room",
      source_, static_cast<double>(points_ * (sizeof(Eigen::Vector3f) + sizeof(Rgb))) / kGiB,
      folder_, std::strerror(errno)));
}

void PointSpill::write(std::size_t first, std::span<const Eigen::Vector3f> xyz,
                       std::span<const Rgb> rgb) {
  const auto put = [&](std::span<const std::byte> bytes, std::size_t at) {
    if (!moveAll(fd_, bytes.data(), bytes.size(), at, ::pwrite)) failToWrite();
  };
  put(std::as_bytes(xyz), first * sizeof(Eigen::Vector3f));
  put(std::as_bytes(rgb), points_ * sizeof(Eigen::Vector3f) + first * sizeof(Rgb));
}

void PointSpill::read(std::size_t first, std::span<Eigen::Vector3f> xyz, std::span<Rgb> rgb) const {
  const auto get = [&](std::span<std::byte> bytes, std::size_t at) {
    if (moveAll(fd_, bytes.data(), bytes.size(), at, ::pread)) return;
    throw InputError(fmt::format("{}: its decoded points in {} cannot be read again: {}", source_,
                                 folder_, std::strerror(errno)));
  };
  get(std::as_writable_bytes(xyz), first * sizeof(Eigen::Vector3f));
  get(std::as_writable_bytes(rgb), points_ * sizeof(Eigen::Vector3f) + first * sizeof(Rgb));
}

}  // namespace agricolmap::io
