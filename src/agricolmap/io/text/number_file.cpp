#include "agricolmap/io/text/number_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// More is no matrix, but some other file given by mistake.
constexpr std::size_t kMaxBytes = 1U << 16;

}  // namespace

NumberFile readNumbers(const std::filesystem::path& path) {
  const MappedFile file(path);
  std::string text(file.text().substr(0, kMaxBytes + 1));
  if (text.size() > kMaxBytes) {
    throw InputError(fmt::format("{}: too long for a file of a few numbers", path.string()));
  }
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);  // byte order mark of Windows editors
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return std::string_view(",;[](){}").find(c) != std::string_view::npos; }, ' ');
  NumberFile result;
  std::string_view rest = text;
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::string_view whole = takeLine(rest);
    for (const std::string_view word : splitWords(whole.substr(0, whole.find('#')))) {
      const auto value = parseNumber(word);
      if (!value) {
        throw InputError(fmt::format("{}: line {}: '{}' is no number", path.string(), line, word));
      }
      if (!std::isfinite(*value)) {
        throw InputError(fmt::format("{}: line {}: '{}' is not finite", path.string(), line, word));
      }
      result.numbers.push_back(*value);
      result.lines.push_back(line);
    }
  }
  return result;
}

std::string exactText(double value) { return fmt::format("{:.17g}", value); }

}  // namespace agricolmap::io
