// Days as numbers that sort: 20260531.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace agricolmap {

/// "2026-05-31" or "20260531" as 20260531; 0 for what is no day of the calendar.
inline std::int32_t dayOf(const std::string& text) {
  std::string digits = text;
  if (text.size() == 10 && text[4] == '-' && text[7] == '-') {
    digits = text.substr(0, 4) + text.substr(5, 2) + text.substr(8);
  }
  if (digits.size() != 8 || digits.find_first_not_of("0123456789") != std::string::npos) return 0;
  const int number = std::stoi(digits);
  const std::chrono::year_month_day day{
      std::chrono::year(number / 10000),
      std::chrono::month(static_cast<unsigned>(number / 100 % 100)),
      std::chrono::day(static_cast<unsigned>(number % 100))};
  return day.ok() ? number : 0;
}

}  // namespace agricolmap
