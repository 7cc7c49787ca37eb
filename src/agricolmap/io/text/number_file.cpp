#include "agricolmap/io/text/number_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/text/commas.hpp"
#include "agricolmap/io/text/foreign_file.hpp"
#include "agricolmap/io/text/mapped_file.hpp"
#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {
namespace {

/// More is no matrix, but some other file given by mistake.
constexpr std::size_t kMaxBytes = 1U << 16;

}  // namespace

NumberFile numbersIn(std::string_view whole_text, const std::string& name) {
  std::string text(whole_text);
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return std::string_view("[](){}").find(c) != std::string_view::npos; }, ' ');
  NumberFile result;
  std::string_view rest = text;
  const char line_end = lineEndOf(rest);
  for (std::size_t line = 1; !rest.empty(); ++line) {
    const std::string_view whole = takeLine(rest, line_end);
    const NumberWords numbers(whole.substr(0, whole.find('#')));
    if (numbers.ambiguous()) {
      throw InputError(fmt::format("{}: line {}: {}", name, line, kAmbiguousCommas));
    }
    for (const std::string_view word : numbers.words()) {
      const auto value = numbers.parse(word);
      if (!value) {
        throw InputError(fmt::format("{}: line {}: '{}' is no number", name, line, word));
      }
      if (!std::isfinite(*value)) {
        throw InputError(fmt::format("{}: line {}: '{}' is not finite", name, line, word));
      }
      result.numbers.push_back(*value);
      result.lines.push_back(line);
    }
  }
  return result;
}

NumberFile readNumbers(const std::filesystem::path& path) {
  const MappedFile file(path);
  const std::string foreign = describeForeign(file.text());
  if (!foreign.empty()) throw InputError(fmt::format("{}: {}", path.string(), foreign));
  if (file.text().size() > kMaxBytes) {
    throw InputError(fmt::format("{}: too long for a file of a few numbers", path.string()));
  }
  return numbersIn(withoutMark(file.text()), path.string());
}

std::string exactText(double value) { return fmt::format("{:.17g}", value); }

}  // namespace agricolmap::io
