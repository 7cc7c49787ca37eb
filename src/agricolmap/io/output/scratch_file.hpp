// Room on the disk for what does not fit into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace agricolmap::io {

/// The folder that TMPDIR names, else /var/tmp: /tmp may be memory.
std::string scratchFolder();

/// A file without a name: gone with this, however the program ends. Everything throws OutputError
/// with the system's reason. Can be written and read from several threads at once.
class ScratchFile {
 public:
  /// `purpose` and `remedy` stand before and behind the reason in messages.
  ScratchFile(const std::filesystem::path& folder, std::string purpose, std::string remedy = "");
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  /// Throws now, rather than at the last byte, where there is no room for so many. File systems
  /// that cannot promise are believed.
  void reserve(std::uint64_t bytes);
  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  [[noreturn]] void fail(int error) const;
  std::string purpose_;
  std::string remedy_;
  int fd_ = -1;
};

}  // namespace agricolmap::io
