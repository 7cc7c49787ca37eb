// A file's bytes without a copy of them.
#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace agricolmap::io {

/// A regular file mapped read-only for as long as this lives. Throws InputError when the file is
/// missing, empty, not a regular file or not readable. The file must not shrink meanwhile.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& path);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  std::span<const std::byte> bytes() const { return bytes_; }
  std::string_view text() const;
  /// Gives back the memory of what was looked at; it is read again, mostly from the system's cache,
  /// when it is looked at next. Throws InputError when the file was changed since it was opened.
  void release() const;

 private:
  std::filesystem::path path_;
  int fd_ = -1;
  struct stat opened_ {};
  std::span<const std::byte> bytes_;
};

}  // namespace agricolmap::io
