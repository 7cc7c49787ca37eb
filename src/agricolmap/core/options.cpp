#include "agricolmap/core/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "agricolmap/core/error.hpp"

namespace agricolmap {

OptionField& OptionTable::add(OptionField field) {
  fields_.push_back(std::move(field));
  return fields_.back();
}

OptionField& OptionTable::number(std::string_view name, double& value, double low, double high,
                                 std::string_view unit, std::string_view help) {
  return add(
      {prefix_ + std::string(name), &value, low, high, std::string(unit), std::string(help)});
}

OptionField& OptionTable::integer(std::string_view name, int& value, int low, int high,
                                  std::string_view unit, std::string_view help) {
  return add({prefix_ + std::string(name), &value, static_cast<double>(low),
              static_cast<double>(high), std::string(unit), std::string(help)});
}

OptionField& OptionTable::flag(std::string_view name, bool& value, std::string_view help) {
  return add({prefix_ + std::string(name), &value, 0.0, 1.0, "", std::string(help)});
}

OptionField& OptionTable::addChoice(std::string_view name, ChoiceRef ref, std::string_view help) {
  const double last = static_cast<double>(ref.names.size()) - 1.0;
  return add({prefix_ + std::string(name), std::move(ref), 0.0, last, "", std::string(help)});
}

void OptionTable::check() const {
  for (const OptionField& field : fields_) {
    double value = 0.0;
    if (const auto* number = std::get_if<double*>(&field.value)) {
      value = **number;
    } else if (const auto* integer = std::get_if<int*>(&field.value)) {
      value = **integer;
    } else {
      continue;
    }
    if (!std::isfinite(value) || value < field.low || value > field.high) {
      throw UsageError(fmt::format("option {} = {} is outside its limits [{}, {}]{}{}", field.path,
                                   value, field.low, field.high, field.unit.empty() ? "" : " ",
                                   field.unit));
    }
  }
}

const OptionField* OptionTable::find(std::string_view path) const {
  const auto it = std::find_if(fields_.begin(), fields_.end(),
                               [&](const OptionField& field) { return field.path == path; });
  return it == fields_.end() ? nullptr : &*it;
}

std::string OptionTable::titleOf(std::string_view path) const {
  const auto found = titles_.find(path);
  return found == titles_.end() ? std::string() : found->second;
}

}  // namespace agricolmap
