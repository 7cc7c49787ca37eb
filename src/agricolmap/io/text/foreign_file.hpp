// Files that are given by mistake, by what they begin with.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace agricolmap::io {

/// What a file is, and what to do, for messages: "it is a pointer of Git LFS, not the file; …".
/// Empty where it is not known. Of the bytes only the first few thousand are looked at.
std::string describeForeign(std::string_view bytes);

/// The same of a file on the disk; empty, too, where it cannot be read.
std::string describeForeignFile(const std::filesystem::path& path);

}  // namespace agricolmap::io
