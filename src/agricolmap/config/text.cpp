#include "agricolmap/config/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>

#include "agricolmap/core/error.hpp"

namespace agricolmap::config {
namespace {

/// The whole of `text` as a number; nothing if it is something else.
template <typename Number>
std::optional<Number> parseNumber(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<bool> parseFlag(std::string_view text) {
  if (text == "true" || text == "yes" || text == "on") return true;
  if (text == "false" || text == "no" || text == "off") return false;
  return std::nullopt;
}

[[noreturn]] void refuse(const OptionField& field, std::string_view text) {
  const bool number =
      std::holds_alternative<double*>(field.value) || std::holds_alternative<int*>(field.value);
  throw UsageError(fmt::format("option {} cannot be '{}'; it must be {}{}", field.path, text,
                               !number                                     ? ""
                               : std::holds_alternative<int*>(field.value) ? "a whole number, "
                                                                           : "a number, ",
                               limitsText(field)));
}

template <typename Number>
std::function<void()> setNumber(const OptionField& field, Number* target, std::string_view text) {
  const std::optional<Number> value = parseNumber<Number>(text);
  const auto wide = value ? static_cast<double>(*value) : 0.0;
  if (!value || !std::isfinite(wide) || wide < field.low || wide > field.high) refuse(field, text);
  return [target, value = *value] { *target = value; };
}

/// Levenshtein distance; of long texts only the beginnings count.
std::size_t editDistance(std::string_view a, std::string_view b) {
  constexpr std::size_t kMaxLength = 100;
  a = a.substr(0, kMaxLength);
  b = b.substr(0, kMaxLength);
  std::array<std::size_t, kMaxLength + 1> row{};
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const std::size_t replaced = diagonal + (a[i] == b[k] ? 0 : 1);
      diagonal = row[k + 1];
      row[k + 1] = std::min({row[k] + 1, row[k + 1] + 1, replaced});
    }
  }
  return row[b.size()];
}

std::string_view lastPart(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

}  // namespace

std::string optionText(const OptionField& field) {
  if (const auto* number = std::get_if<double*>(&field.value)) return fmt::format("{}", **number);
  if (const auto* integer = std::get_if<int*>(&field.value)) return fmt::format("{}", **integer);
  if (const auto* flag = std::get_if<bool*>(&field.value)) return **flag ? "true" : "false";
  const auto& choice = std::get<ChoiceRef>(field.value);
  return choice.names.at(static_cast<std::size_t>(choice.get()));
}

std::string limitsText(const OptionField& field) {
  if (const auto* choice = std::get_if<ChoiceRef>(&field.value)) {
    return fmt::format("{}", fmt::join(choice->names, " or "));
  }
  if (std::holds_alternative<bool*>(field.value)) return "true or false";
  return fmt::format("{} to {}{}{}", field.low, field.high, field.unit.empty() ? "" : " ",
                     field.unit);
}

std::function<void()> parseOption(const OptionField& field, std::string_view text) {
  if (const auto* number = std::get_if<double*>(&field.value)) {
    return setNumber(field, *number, text);
  }
  if (const auto* integer = std::get_if<int*>(&field.value)) {
    return setNumber(field, *integer, text);
  }
  if (const auto* flag = std::get_if<bool*>(&field.value)) {
    const std::optional<bool> value = parseFlag(text);
    if (!value) refuse(field, text);
    return [target = *flag, value = *value] { *target = value; };
  }
  const auto& choice = std::get<ChoiceRef>(field.value);
  const auto found = std::find(choice.names.begin(), choice.names.end(), text);
  if (found == choice.names.end()) refuse(field, text);
  return [set = choice.set, value = static_cast<int>(found - choice.names.begin())] { set(value); };
}

bool hasLevels(const OptionTable& table) {
  const std::vector<OptionField>& fields = table.fields();
  return std::any_of(fields.begin(), fields.end(),
                     [&](const OptionField& field) { return field.level != fields.front().level; });
}

std::string closestPath(const OptionTable& table, std::string_view path) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, path.size() / 3) + 1;
  for (const OptionField& field : table.fields()) {
    // The option itself and the groups it is in.
    for (std::size_t end = field.path.size(); end != std::string::npos && end > 0;
         end = field.path.rfind('.', end - 1)) {
      const std::string_view known = std::string_view(field.path).substr(0, end);
      // A right name in the wrong group is as likely as a misspelt one.
      const std::size_t distance =
          std::min(editDistance(path, known), editDistance(lastPart(path), lastPart(known)) + 1);
      if (distance < best_distance) {
        best_distance = distance;
        best = known;
      }
    }
  }
  return best;
}

std::string suggestion(const OptionTable& table, std::string_view path) {
  const std::string closest = closestPath(table, path);
  return closest.empty() ? "" : fmt::format(" (did you mean '{}'?)", closest);
}

std::string suggestion(const std::vector<std::string>& known, std::string_view word) {
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  std::string closest;
  for (const std::string& one : known) {
    const std::size_t distance = editDistance(word, one);
    if (distance < least) closest = one;
    least = std::min(least, distance);
  }
  return closest.empty() ? "" : fmt::format(" (did you mean '{}'?)", closest);
}

}  // namespace agricolmap::config
