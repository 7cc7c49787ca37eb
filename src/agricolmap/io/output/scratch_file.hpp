// Room on the disk for what does not fit into memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// A file without a name in the folder of a result: gone with this, whatever happens. Everything
/// throws OutputError with the system's reason. From several threads at once.
class ScratchFile {
 public:
  /// `beside`: the result.
  explicit ScratchFile(const OutputPath& beside);
  ~ScratchFile();
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  void write(std::uint64_t offset, std::span<const std::byte> bytes);
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  [[noreturn]] void fail(const char* what) const;
  std::string shown_;
  int fd_ = -1;
};

}  // namespace agricolmap::io
