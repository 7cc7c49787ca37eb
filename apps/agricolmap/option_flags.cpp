#include "option_flags.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "agricolmap/config/text.hpp"

namespace agricolmap {
namespace {

std::string helpOf(const OptionField& field) {
  return fmt::format("{} [{}{}{}; {}]", field.help, config::optionText(field),
                     field.unit.empty() ? "" : " ", field.unit, config::limitsText(field));
}

std::string headingOf(const OptionTable& table, const OptionField& field,
                      const std::string& otherwise) {
  const std::string title = table.titleOf(field.group());
  return title.empty() ? otherwise : fmt::format("{}: {}", field.group(), title);
}

/// Options that the help leaves out for now, with the heading that they will have.
using Hidden = std::vector<std::pair<CLI::Option*, std::string>>;

void addHelpAll(CLI::App& app, const std::shared_ptr<Hidden>& hidden) {
  app.add_flag_callback(
      "--help-all",
      [hidden] {
        for (const auto& [option, heading] : *hidden) option->group(heading);
        hidden->clear();
        throw CLI::CallForHelp();
      },
      "Print this help message with all options and exit");
  app.footer([hidden, &app] {
    if (hidden->empty()) return std::string();
    const bool dumps = app.get_option_no_throw("--dump-config") != nullptr;
    return fmt::format(
        "{} more options, for those who change how a stage works: agricolmap {} --help-all\n"
        "or docs/options.md{}.\n",
        hidden->size(), app.get_name(), dumps ? "; --dump-config writes them all into a file" : "");
  });
}

}  // namespace

std::string flagOf(std::string_view path) {
  std::string flag = "--" + std::string(path);
  std::replace(flag.begin(), flag.end(), '_', '-');
  return flag;
}

std::string spelledWithDashes(std::string_view argument) {
  std::string text(argument);
  if (!text.starts_with("--")) return text;
  const std::size_t name = std::min(text.find('='), text.size());
  std::replace(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(name), '_', '-');
  return text;
}

void OptionFlags::addTo(CLI::App& app, const OptionTable& table, const std::string& heading,
                        const std::vector<std::string>& left_out) {
  const bool levels = config::hasLevels(table);
  const auto hidden = std::make_shared<Hidden>();
  for (const OptionField& field : table.fields()) {
    if (std::find(left_out.begin(), left_out.end(), field.path) != left_out.end()) continue;
    auto text = std::make_shared<std::string>();
    texts_[field.path] = text;
    CLI::Option* option = app.add_option(flagOf(field.path), *text, helpOf(field));
    const std::string group = headingOf(table, field, heading);
    const bool hide = levels && field.level == OptionLevel::kAdvanced;
    option->group(hide ? "" : group);
    if (hide) hidden->emplace_back(option, group);
    if (std::holds_alternative<bool*>(field.value)) {
      // A flag may stand alone: `--geometry-only` means true.
      option->expected(0, 1)->default_str("true");
    }
  }
  if (levels) addHelpAll(app, hidden);
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

std::vector<std::string> OptionFlags::given() const {
  std::vector<std::string> paths;
  for (const auto& [path, text] : texts_) {
    if (!text->empty()) paths.push_back(path);
  }
  return paths;
}

}  // namespace agricolmap
