#include "agricolmap/config/markdown.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "agricolmap/config/text.hpp"

namespace agricolmap::config {
namespace {

/// Text that cannot end a cell of a table.
std::string cell(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '|') out += '\\';
    out += c == '\n' ? ' ' : c;
  }
  return out;
}

std::string limitsCell(const OptionField& field) {
  if (std::holds_alternative<bool*>(field.value)) return "";
  if (std::holds_alternative<ChoiceRef>(field.value)) return limitsText(field);
  return fmt::format("{} to {}", field.low, field.high);
}

/// The fields that `wanted` picks.
template <typename Wanted>
std::string rowsOf(const OptionTable& table, Wanted wanted) {
  std::string out = "| option | default | unit | limits | meaning |\n|---|---|---|---|---|\n";
  for (const OptionField& field : table.fields()) {
    if (!wanted(field)) continue;
    out += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.path, cell(optionText(field)),
                       cell(field.unit), cell(limitsCell(field)), cell(field.help));
  }
  return out;
}

}  // namespace

std::string toMarkdown(const OptionTable& table) {
  if (!hasLevels(table)) {
    return rowsOf(table, [](const OptionField&) { return true; });
  }
  std::string out = "### For users\n\n" + rowsOf(table, [](const OptionField& field) {
                      return field.level == OptionLevel::kBasic;
                    });
  std::vector<std::string> groups;
  for (const OptionField& field : table.fields()) {
    const std::string group(field.group());
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  for (const std::string& group : groups) {
    const std::string title = table.titleOf(group);
    out += fmt::format("\n### {}{}\n\n", group.empty() ? "All: outside groups" : "All: " + group,
                       title.empty() ? "" : ", " + title) +
           rowsOf(table, [&](const OptionField& field) { return field.group() == group; });
  }
  return out;
}

}  // namespace agricolmap::config
