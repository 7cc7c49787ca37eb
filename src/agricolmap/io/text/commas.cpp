#include "agricolmap/io/text/commas.hpp"

#include <algorithm>

namespace agricolmap::io {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Whether a word can be one number with a decimal comma.
bool canBeDecimal(std::string_view word) {
  const std::size_t comma = word.find(',');
  if (comma == 0 || comma + 1 >= word.size()) return false;
  if (!isDigit(word[comma - 1]) || !isDigit(word[comma + 1])) return false;
  return word.find('.') == std::string_view::npos && parseCommaNumber(word).has_value();
}

}  // namespace

CommaUse commaUseOf(std::string_view line) {
  std::string text(line);
  std::replace(text.begin(), text.end(), ';', ' ');
  CommaUse use = CommaUse::kNone;
  for (std::string_view word : splitWords(text)) {
    while (word.starts_with(',')) word.remove_prefix(1);
    while (word.ends_with(',')) word.remove_suffix(1);
    if (word.find(',') == std::string_view::npos) continue;
    if (!canBeDecimal(word)) return CommaUse::kSeparator;
    use = CommaUse::kEither;
  }
  if (use == CommaUse::kNone) return use;
  if (line.find('.') != std::string_view::npos) return CommaUse::kSeparator;
  return line.find(';') != std::string_view::npos ? CommaUse::kDecimal : CommaUse::kEither;
}

std::optional<double> parseCommaNumber(std::string_view word) {
  constexpr std::size_t kLongest = 64;
  const std::size_t comma = word.find(',');
  if (comma == std::string_view::npos || word.size() > kLongest) return parseNumber(word);
  if (word.find('.') != std::string_view::npos) return std::nullopt;
  std::string text(word);
  text[comma] = '.';
  return parseNumber(text);
}

NumberWords::NumberWords(std::string_view line) : use_(commaUseOf(line)), text_(line) {
  std::replace(text_.begin(), text_.end(), ';', ' ');
  if (use_ != CommaUse::kDecimal) std::replace(text_.begin(), text_.end(), ',', ' ');
}

std::string_view takeField(std::string_view& line, char separator) {
  const std::size_t end = std::min(line.find(separator), line.size());
  std::string_view word = line.substr(0, end);
  line.remove_prefix(std::min(end + 1, line.size()));
  const auto around = [](char c) { return isBlank(c) || c == '"'; };
  while (!word.empty() && around(word.front())) word.remove_prefix(1);
  while (!word.empty() && around(word.back())) word.remove_suffix(1);
  return word;
}

}  // namespace agricolmap::io
