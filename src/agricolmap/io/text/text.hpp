// Lines, words and numbers of text, whatever the locale.
#pragma once

#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <system_error>
#include <vector>

namespace agricolmap::io {

inline bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

/// The first word of `text`, taken off it; empty when there is none left.
inline std::string_view takeWord(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && isBlank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !isBlank(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

inline std::vector<std::string_view> splitWords(std::string_view text) {
  std::vector<std::string_view> words;
  for (auto word = takeWord(text); !word.empty(); word = takeWord(text)) words.push_back(word);
  return words;
}

/// The first line of `text` without its end (LF or CR LF), taken off it.
inline std::string_view takeLine(std::string_view& text) {
  const std::size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// A whole word as a number, NaN and infinities included; nothing when it is none. Numbers too
/// large for a double become infinite, too small ones zero.
inline std::optional<double> parseNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return std::nullopt;
  if (error == std::errc{}) return value;
  if (error != std::errc::result_out_of_range) return std::nullopt;
  const bool tiny =
      word.find("e-") != std::string_view::npos || word.find("E-") != std::string_view::npos;
  return tiny ? 0.0 : std::numeric_limits<double>::infinity();
}

/// A whole word as an integer; nothing when it is none or does not fit.
inline std::optional<std::int64_t> parseInteger(std::string_view word) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace agricolmap::io
