#include "agricolmap/batch/file_pattern.hpp"

#include <fmt/format.h>
#include <glob.h>
#include <regex.h>

#include <memory>
#include <optional>

#include "agricolmap/core/error.hpp"

namespace agricolmap::batch {
namespace fs = std::filesystem;
namespace {

/// What glob would take for a wildcard is none in the name of the manifest's own folder.
std::string quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (std::string_view("*?[]\\").find(c) != std::string_view::npos) safe += '\\';
    safe += c;
  }
  return safe;
}

/// The extended regular expression that a pattern stands for, with a group for each wildcard.
std::string expressionOf(const std::string& pattern) {
  std::string text = "^";
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    const std::size_t close = c == '[' ? pattern.find(']', i + 2) : std::string::npos;
    if (c == '*') {
      text += "([^/]*)";
    } else if (c == '?') {
      text += "([^/])";
    } else if (close != std::string::npos) {
      std::string members = pattern.substr(i + 1, close - i - 1);
      if (members.front() == '!') members.front() = '^';
      text += "([" + members + "])";
      i = close;
    } else {
      if (std::string_view("\\^$.|+()[{").find(c) != std::string_view::npos) text += '\\';
      text += c;
    }
  }
  return text + "$";
}

/// What a pattern's wildcards stand for in names.
class PatternParts {
 public:
  explicit PatternParts(const std::string& pattern)
      : status_(::regcomp(&compiled_, expressionOf(pattern).c_str(), REG_EXTENDED)) {}
  ~PatternParts() {
    if (status_ == 0) ::regfree(&compiled_);
  }
  PatternParts(const PatternParts&) = delete;
  PatternParts& operator=(const PatternParts&) = delete;

  /// Nothing for names that it does not fit.
  std::optional<std::vector<std::string>> of(const std::string& name) const {
    if (status_ != 0) return std::nullopt;
    std::vector<regmatch_t> groups(compiled_.re_nsub + 1);
    if (::regexec(&compiled_, name.c_str(), groups.size(), groups.data(), 0) != 0) {
      return std::nullopt;
    }
    std::vector<std::string> parts;
    for (std::size_t i = 1; i < groups.size(); ++i) {
      const auto begin = static_cast<std::size_t>(groups[i].rm_so);
      parts.push_back(name.substr(begin, static_cast<std::size_t>(groups[i].rm_eo) - begin));
    }
    return parts;
  }

 private:
  regex_t compiled_{};
  int status_;
};

}  // namespace

bool hasWildcards(const std::string& name) {
  return name.find_first_of("*?[") != std::string::npos;
}

std::vector<FoundFile> filesLike(const fs::path& folder, const std::string& pattern) {
  const bool absolute = fs::path(pattern).is_absolute();
  const std::string prefix = absolute || folder.empty() ? "" : folder.string() + "/";
  glob_t found{};
  const int status = ::glob((quoted(prefix) + pattern).c_str(), 0, nullptr, &found);
  const std::unique_ptr<glob_t, void (*)(glob_t*)> release(&found, ::globfree);
  std::vector<FoundFile> files;
  if (status != 0) return files;
  const PatternParts wildcards(pattern);
  for (std::size_t i = 0; i < found.gl_pathc; ++i) {
    const std::string path = found.gl_pathv[i];
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored)) continue;
    if (const auto parts = wildcards.of(path.substr(prefix.size()))) {
      files.push_back({path, *parts});
    }
  }
  return files;
}

std::string stemOf(const fs::path& file) {
  fs::path name = file.filename().stem();
  if (name.extension() == ".copc") name = name.stem();
  return name.string();
}

std::string filledIn(const std::string& text, const FoundFile& file) {
  std::string filled;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t close = text[i] == '{' ? text.find('}', i) : std::string::npos;
    if (close == std::string::npos) {
      filled += text[i];
      continue;
    }
    const std::string name = text.substr(i + 1, close - i - 1);
    const bool digits = !name.empty() && name.size() < 3 &&
                        name.find_first_not_of("0123456789") == std::string::npos;
    const std::size_t number = digits ? std::stoul(name) : 0;
    if (name == "name") {
      filled += stemOf(file.file);
    } else if (number >= 1 && number <= file.parts.size()) {
      filled += file.parts[number - 1];
    } else {
      throw UsageError(fmt::format(
          "'{{{}}}' stands for nothing here: {{name}} is the file's name without its ending, {{1}} "
          "what its first wildcard stands for; this one has {} of them",
          name, file.parts.size()));
    }
    i = close;
  }
  return filled;
}

}  // namespace agricolmap::batch
