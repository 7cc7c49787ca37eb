// Where a file is written, and what it is called in messages.
#pragma once

#include <concepts>
#include <filesystem>
#include <string>
#include <utility>

namespace agricolmap::io {

/// A file (or folder) being written out of sight, see StagedOutput: errors name the place the user
/// asked for, as he will never meet the hidden one. Any plain path is one that shows itself.
class OutputPath {
 public:
  template <typename Path>
  requires std::convertible_to<const Path&, std::filesystem::path> OutputPath(
      const Path& path)  // NOLINT(*-explicit-*): a path is an output path
      : file_(path), shown_(file_) {}
  OutputPath(std::filesystem::path file, std::filesystem::path shown)
      : file_(std::move(file)), shown_(std::move(shown)) {}

  /// To be opened.
  const std::filesystem::path& file() const { return file_; }
  /// For messages.
  std::string shown() const { return shown_.string(); }
  OutputPath operator/(const std::string& name) const { return {file_ / name, shown_ / name}; }

 private:
  std::filesystem::path file_;
  std::filesystem::path shown_;
};

}  // namespace agricolmap::io
