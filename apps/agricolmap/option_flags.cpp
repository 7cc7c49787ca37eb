#include "option_flags.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "agricolmap/config/text.hpp"

namespace agricolmap {
namespace {

std::string helpOf(const OptionField& field) {
  return fmt::format("{} [{}{}{}; {}]", field.help, config::optionText(field),
                     field.unit.empty() ? "" : " ", field.unit, config::limitsText(field));
}

}  // namespace

void OptionFlags::addTo(CLI::App& app, const OptionTable& table, const std::string& group,
                        const std::vector<std::string>& left_out) {
  for (const OptionField& field : table.fields()) {
    if (std::find(left_out.begin(), left_out.end(), field.path) != left_out.end()) continue;
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
    if (field != nullptr && !text->empty()) config::parseOption(*field, *text)();
  }
  table.check();
}

bool OptionFlags::given(const std::string& path) const {
  const auto found = texts_.find(path);
  return found != texts_.end() && !found->second->empty();
}

bool OptionFlags::anyGiven() const {
  return std::any_of(texts_.begin(), texts_.end(),
                     [](const auto& entry) { return !entry.second->empty(); });
}

}  // namespace agricolmap
