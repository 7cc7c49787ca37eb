// Commas in lines of numbers: decimal marks or separators, never both.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/io/text/text.hpp"

namespace agricolmap::io {

enum class CommaUse {
  kNone,       ///< there is none, or only such as separate: "1, 2"
  kSeparator,  ///< "1.5,2.5", "1,2,3"
  kDecimal,    ///< "1,5;2,5"
  kEither,     ///< "1,5 2,5": three numbers or six
};

/// By all words of a line.
CommaUse commaUseOf(std::string_view line);

/// A whole word as a number whose decimal mark is a comma or a point.
std::optional<double> parseCommaNumber(std::string_view word);

/// The values of a line that blanks, commas and semicolons keep apart.
class NumberWords {
 public:
  explicit NumberWords(std::string_view line);
  /// Whether commas may be decimal marks as well as separators: see kAmbiguousCommas.
  bool ambiguous() const { return use_ == CommaUse::kEither; }
  std::vector<std::string_view> words() const { return splitWords(text_); }
  std::optional<double> parse(std::string_view word) const {
    return use_ == CommaUse::kDecimal ? parseCommaNumber(word) : parseNumber(word);
  }

 private:
  CommaUse use_;
  std::string text_;  ///< separators are blanks
};
inline constexpr std::string_view kAmbiguousCommas =
    "its commas may be decimal marks as well as separators; write decimals with a point, or "
    "separate "
    "values by semicolons";

/// The next value of a line whose values `separator` keeps apart, without blanks and quotes around
/// it, taken off with the separator; empty when there is none.
std::string_view takeField(std::string_view& line, char separator);

}  // namespace agricolmap::io
