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
MappedFile::MappedFile(const std::filesystem::path& path) : path_(path) {
  const auto fail = [&](const std::string& what) {
    if (fd_ >= 0) ::close(fd_);
    throw InputError(fmt::format("{}: {}", path.string(), what));
  };
  const auto because = [](const char* what) {
    return fmt::format("{}: {}", what, std::strerror(errno));
  };
  fd_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd_ < 0) fail(because("cannot be opened"));
  if (::fstat(fd_, &opened_) != 0) fail(because("cannot be examined"));
  if (!S_ISREG(opened_.st_mode)) {
    fail(fmt::format("is {}, not a regular file",
                     S_ISDIR(opened_.st_mode) ? "a directory" : "a device or pipe"));
  }
  if (opened_.st_size == 0) fail("the file is empty");
  const auto size = static_cast<std::size_t>(opened_.st_size);
  void* const address = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, fd_, 0);
  if (address == MAP_FAILED) fail(because("cannot be mapped into memory"));
  ::madvise(address, size, MADV_WILLNEED);  // read ahead; failing to is harmless
  bytes_ = {static_cast<const std::byte*>(address), size};
}

MappedFile::~MappedFile() {
  ::munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
  ::close(fd_);
}

void MappedFile::release() const {
  ::madvise(const_cast<std::byte*>(bytes_.data()), bytes_.size(), MADV_DONTNEED);
  struct stat now {};
  if (::fstat(fd_, &now) == 0 && now.st_size == opened_.st_size &&
      now.st_mtim.tv_sec == opened_.st_mtim.tv_sec &&
      now.st_mtim.tv_nsec == opened_.st_mtim.tv_nsec) {
    return;
  }
  throw InputError(fmt::format("{}: was changed while it was read", path_.string()));
}

std::string_view MappedFile::text() const {
  return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
}

}  // namespace agricolmap::io
