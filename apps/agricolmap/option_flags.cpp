#include "option_flags.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "agricolmap/config/text.hpp"

namespace agricolmap {
namespace {

std::string helpOf(const OptionField& field) {
  std::string unit = field.unit.empty() ? "" : " " + field.unit;
  if (const auto* choice = std::get_if<ChoiceRef>(&field.value)) {
    return fmt::format("{} {{{}}} [{}]", field.help, fmt::join(choice->names, "|"),
                       textOf(field));
  }
  if (std::holds_alternative<bool*>(field.value)) {
    return fmt::format("{} [{}]", field.help, textOf(field));
  }
  return fmt::format("{} [{}{}; {} to {}]", field.help, textOf(field), unit, field.low, field.high);
}

}  // namespace

void OptionFlags::addTo(CLI::App& app, const OptionTable& table, const std::string& group) {
  for (const OptionField& field : table.fields()) {
    auto text = std::make_shared<std::string>();
    texts_[field.path] = text;
    CLI::Option* option = app.add_option("--" + field.path, *text, helpOf(field));
    option->group(group);
    if (std::holds_alternative<bool*>(field.value)) {
      // A flag may stand alone: `--geometry_only` means true.
      option->expected(0, 1)->default_str("true");
    }
  }
}

void OptionFlags::apply(const OptionTable& table) const {
  for (const auto& [path, text] : texts_) {
    const OptionField* field = table.find(path);
    if (field != nullptr && !text->empty()) setFromText(*field, *text, "--" + path);
  }
  table.check();
}

}  // namespace agricolmap
