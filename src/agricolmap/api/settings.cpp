#include "agricolmap/api/settings.hpp"

#include <fmt/format.h>

#include <variant>

#include "agricolmap/config/text.hpp"
#include "agricolmap/core/error.hpp"

namespace agricolmap {
namespace {

OptionInfo infoOf(const OptionField& field) {
  OptionInfo info;
  info.name = field.path;
  info.unit = field.unit;
  info.limits = config::limitsText(field);
  info.default_value = config::optionText(field);
  info.help = field.help;
  info.basic = field.level == OptionLevel::kBasic;
  if (std::holds_alternative<bool*>(field.value)) {
    info.kind = OptionInfo::Kind::kFlag;
  } else if (const auto* choice = std::get_if<ChoiceRef>(&field.value)) {
    info.kind = OptionInfo::Kind::kChoice;
    info.choices = choice->names;
  } else {
    const bool whole = std::holds_alternative<int*>(field.value);
    info.kind = whole ? OptionInfo::Kind::kInteger : OptionInfo::Kind::kNumber;
    info.low = field.low;
    info.high = field.high;
  }
  return info;
}

}  // namespace

const OptionField& fieldOf(const OptionTable& table, std::string_view name) {
  const OptionField* const field = table.find(name);
  if (field == nullptr) {
    throw UsageError(
        fmt::format("there is no option '{}'{}", name, config::suggestion(table, name)));
  }
  return *field;
}

std::vector<OptionInfo> infosOf(const OptionTable& table) {
  std::vector<OptionInfo> infos;
  for (const OptionField& field : table.fields()) infos.push_back(infoOf(field));
  return infos;
}

void setOption(const OptionField& field, std::string_view value) {
  config::parseOption(field, value)();
}

}  // namespace agricolmap
