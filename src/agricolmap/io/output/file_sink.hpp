// Writing files so that no failure goes unnoticed.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// A file being written, unbuffered: hand it large pieces. Everything throws OutputError with the
/// system's reason. Existing files are truncated.
class FileSink {
 public:
  explicit FileSink(OutputPath path);
  ~FileSink();
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  void write(std::span<const std::byte> bytes);
  void write(std::string_view text);
  /// Bytes written so far.
  std::size_t size() const { return size_; }
  /// Replaces bytes that were written before.
  void rewrite(std::size_t offset, std::span<const std::byte> bytes);
  /// Closes; call it before relying on the file: some file systems report a full disk only here.
  void close();

 private:
  [[noreturn]] void fail(std::string_view what) const;
  OutputPath path_;
  int fd_ = -1;
  std::size_t size_ = 0;
};

/// Writes a whole file.
void writeText(const OutputPath& path, std::string_view text);

}  // namespace agricolmap::io
