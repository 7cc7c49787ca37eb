// A folder that is replaced as a whole, in one step.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "agricolmap/io/output/output_path.hpp"

namespace agricolmap::io {

/// A folder that is made anew beside the one that is there, and changes places with it at once:
/// whatever kills the program, one finds the old one or the new one, never a part of either.
/// Destroyed without commit it leaves everything as it was.
///
/// It is filled in `.<name>.next-<pid>` beside the target; what an earlier, killed run left there
/// is removed. Where the file system cannot exchange two folders, the old one is set aside for a
/// moment as `.<name>.old`, and put back by the next run should this one be killed just then.
class SwappedFolder {
 public:
  /// Makes missing parents. Throws OutputError when `dir` is a file, or its parent cannot be made
  /// or written.
  explicit SwappedFolder(const std::filesystem::path& dir);
  ~SwappedFolder();
  SwappedFolder(const SwappedFolder&) = delete;
  SwappedFolder& operator=(const SwappedFolder&) = delete;

  /// The folder as it is now, if there is one.
  const std::filesystem::path& directory() const { return target_; }
  /// Where to write the file `name` (relative; may be in a subfolder, which is made).
  OutputPath path(const std::string& name) const;
  /// Takes a file of the present folder along as it is, by a hard link where that can be.
  void keep(const std::string& name) const;
  /// Takes all files along that are not in the new folder and for which `foreign` is true of their
  /// name within the folder: those that somebody else put there.
  void keepOthers(const std::function<bool(const std::filesystem::path&)>& foreign) const;
  /// Puts the new folder in place and removes the old one.
  void commit();

 private:
  std::filesystem::path asked_;
  std::filesystem::path target_;
  std::filesystem::path staging_;
  int lock_ = -1;  ///< of the present folder
  bool committed_ = false;
};

}  // namespace agricolmap::io
