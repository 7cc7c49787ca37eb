// A folder of results that grows from run to run and is replaced as a whole each time.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "agricolmap/io/output/staged_output.hpp"

namespace agricolmap::io {

/// A StagedOutput that takes the place of the present folder at once, may take files of it along,
/// and keeps other runs from it meanwhile: whatever kills the program, one finds the old folder or
/// the new one, never a part of either. What killed runs left beside it is removed or, where the
/// file system cannot exchange two folders and one was killed just then, put back.
class SwappedFolder {
 public:
  /// Makes missing parents. Throws OutputError when `dir` is a file, its parent cannot be made or
  /// written, or another run is making the same folder anew.
  explicit SwappedFolder(const std::filesystem::path& dir);
  ~SwappedFolder();
  SwappedFolder(const SwappedFolder&) = delete;
  SwappedFolder& operator=(const SwappedFolder&) = delete;

  /// The folder as it is now, if there is one, absolute.
  const std::filesystem::path& directory() const { return staged_->directory(); }
  /// Where to write the file `name` (relative; may be in a subfolder, which is made).
  OutputPath path(const std::string& name) const { return staged_->path(name); }
  /// Takes a file of the present folder along as it is, by a hard link where that can be.
  void keep(const std::string& name) const;
  /// Takes all files along that are not in the new folder and for which `foreign` is true of their
  /// name within the folder: those that somebody else put there.
  void keepOthers(const std::function<bool(const std::filesystem::path&)>& foreign) const;
  /// Puts the new folder in place and removes the old one.
  void commit() { staged_->commit(); }

 private:
  int lock_ = -1;  ///< of the present folder
  std::optional<StagedOutput> staged_;
};

}  // namespace agricolmap::io
