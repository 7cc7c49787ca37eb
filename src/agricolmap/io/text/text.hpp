// Lines, words and numbers of text, whatever the locale.
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
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

inline std::string lowerCase(std::string_view word) {
  std::string text(word);
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// `text` without the byte order mark of UTF-8 that Windows' editors put first.
inline std::string_view withoutMark(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  return text;
}

/// What ends the lines of a text, by its first: LF, also behind a CR, or CR alone as of old Macs.
inline char lineEndOf(std::string_view text) {
  const std::size_t at = text.find_first_of("\r\n");
  if (at == std::string_view::npos || text[at] == '\n') return '\n';
  return at + 1 < text.size() && text[at + 1] == '\n' ? '\n' : '\r';
}

/// The first line of `text` without its end (`line_end`; LF also with a CR before it), taken off.
inline std::string_view takeLine(std::string_view& text, char line_end = '\n') {
  const std::size_t end = text.find(line_end);
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// `1.#QNAN`, `-1.#IND00`, `1.#INF`: how old libraries of Windows write what is no number.
inline std::optional<double> parseWindowsSpecial(std::string_view word) {
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  if (!word.starts_with("1.#")) return std::nullopt;
  word.remove_prefix(3);
  while (word.ends_with('0')) word.remove_suffix(1);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (word == "INF") return negative ? -kInfinity : kInfinity;
  if (word == "QNAN" || word == "SNAN" || word == "IND") {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return std::nullopt;
}

/// A whole word as a number, NaN and infinities included; nothing when it is none. Numbers too
/// large for a double become infinite, too small ones zero.
inline std::optional<double> parseNumber(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return parseWindowsSpecial(word);
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
