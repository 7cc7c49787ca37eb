// Results are written whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// What becomes of a folder that is there already.
enum class Existing {
  kRefuse,   ///< unless it is empty
  kMerge,    ///< files of the same names are replaced, others stay
  kReplace,  ///< all that is in it goes, at once
};

/// If a file or folder of this name is one that a StagedOutput or StagedFile fills, or that a
/// killed one has left: the name of its target; else empty.
std::string targetOfHidden(const std::string& name);

/// What is replaced waits under this name in the hidden folder where a file system cannot exchange
/// two folders.
inline constexpr const char* kSetAside = "old";

/// A folder of results, filled out of sight and put in place by `commit`. Destroyed without commit
/// (an exception, an interrupt), it leaves everything as it was.
///
/// The hidden folder is `.<name>.partial-<pid>`, beside the target or, when the target exists,
/// inside it: only there it is sure to be on the same file system (mounted volumes). One that is
/// replaced as a whole cannot be a mount, and is filled beside it, too.
class StagedOutput {
 public:
  /// Makes missing parents. Throws OutputError when `dir` is a file, cannot be made or written, or
  /// is not empty and `overwrite` is off.
  StagedOutput(const std::filesystem::path& dir, bool overwrite)
      : StagedOutput(dir, overwrite ? Existing::kMerge : Existing::kRefuse) {}
  StagedOutput(const std::filesystem::path& dir, Existing existing);
  ~StagedOutput();
  StagedOutput(const StagedOutput&) = delete;
  StagedOutput& operator=(const StagedOutput&) = delete;

  /// Where to write the file `name` (relative; may be in a subfolder, which is made).
  OutputPath path(const std::string& name) const;
  /// The folder to write into, for those who name their files themselves.
  OutputPath folder() const;
  /// Puts every file in place, replacing those of the same names, and removes files in
  /// `stale_names` (left by an earlier run) that this run did not write; other files of the folder
  /// stay. When one step fails, all are undone and OutputError is thrown. A folder that is replaced
  /// is the old or the new one at any moment, where the file system can exchange two (Linux's own
  /// can); else there may be none for a moment.
  void commit(const std::vector<std::string>& stale_names = {});

  /// The target folder, absolute.
  const std::filesystem::path& directory() const { return target_; }

 private:
  void moveAside(const std::filesystem::path& name);
  void rollBack() noexcept;
  void mergeInto(const std::filesystem::path& fresh, const std::vector<std::string>& stale_names);
  void replaceBy(const std::filesystem::path& fresh);

  std::filesystem::path asked_;   ///< the target as the user wrote it
  std::filesystem::path target_;  ///< the same, absolute
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_parents_;  ///< innermost first
  struct Move {
    std::filesystem::path from;
    std::filesystem::path to;
  };
  std::vector<Move> moves_;  ///< done so far by `commit`
  bool target_existed_ = false;
  Existing existing_;
};

/// The same for a command that writes one file. Devices and pipes (/dev/stdout) are written
/// straight.
class StagedFile {
 public:
  /// Makes missing parents. Throws OutputError when `path` is a folder, cannot be written, or
  /// exists and `overwrite` is off.
  StagedFile(const std::filesystem::path& path, bool overwrite);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  /// Where to write.
  OutputPath path() const { return {staging_, asked_}; }
  /// Puts the file in place.
  void commit();

 private:
  std::filesystem::path asked_;
  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_parents_;
  bool committed_ = false;
};

}  // namespace agricolmap::io
