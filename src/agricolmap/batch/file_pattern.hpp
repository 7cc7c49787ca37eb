// Names of files with wildcards, and names made of what these stood for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace agricolmap::batch {

/// A file that a pattern fits.
struct FoundFile {
  std::filesystem::path file;      ///< to be opened
  std::vector<std::string> parts;  ///< what the wildcards stand for, in their order
};

/// Whether a name has one of `*?[`.
bool hasWildcards(const std::string& name);

/// The files, relative to `folder`, that `pattern` fits, sorted: `*` and `?` stand for what has no
/// slash, `[a-c]` for one of several characters.
std::vector<FoundFile> filesLike(const std::filesystem::path& folder, const std::string& pattern);

/// Name of a file without its folder and endings: "row7" of "a/row7.copc.laz".
std::string stemOf(const std::filesystem::path& file);

/// `text` with `{name}` replaced by the file's stem, `{1}`, `{2}`, ... by the parts. Throws
/// UsageError for braces around anything else.
std::string filledIn(const std::string& text, const FoundFile& file);

}  // namespace agricolmap::batch
