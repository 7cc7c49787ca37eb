#include "agricolmap/io/text/mapped_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "agricolmap/core/error.hpp"

namespace agricolmap::io {
namespace {

/// A file descriptor that closes itself.
struct Descriptor {
  int fd;
  ~Descriptor() {
    if (fd >= 0) ::close(fd);
  }
};

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  const auto fail = [&](const char* what) {
    throw InputError(fmt::format("{}: {}: {}", path.string(), what, std::strerror(errno)));
  };
  const Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)};
  if (file.fd < 0) fail("cannot be opened");
  struct stat info {};
  if (::fstat(file.fd, &info) != 0) fail("cannot be examined");
  if (!S_ISREG(info.st_mode)) {
    throw InputError(fmt::format("{}: is {}, not a regular file", path.string(),
                                 S_ISDIR(info.st_mode) ? "a directory" : "a device or pipe"));
  }
  if (info.st_size == 0) throw InputError(fmt::format("{}: the file is empty", path.string()));
  const auto size = static_cast<std::size_t>(info.st_size);
  void* const address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.fd, 0);
  if (address == MAP_FAILED) fail("cannot be mapped into memory");
  ::madvise(address, size, MADV_WILLNEED);  // read ahead; failing to is harmless
  bytes_ = {static_cast<const std::byte*>(address), size};
}

MappedFile::~MappedFile() { ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size()); }

void MappedFile::forget() const {
  ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
}

std::string_view MappedFile::text() const {
  return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
}

}  // namespace agricolmap::io
