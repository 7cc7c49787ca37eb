// A file's bytes without a copy of them.
#pragma once

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
  /// Lets go of the memory of what was read, which is read again where it is asked for again: for
  /// those who go through large files once.
  void forget() const;

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace agricolmap::io
