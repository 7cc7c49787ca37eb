#include "agricolmap/config/markdown.hpp"

#include <fmt/format.h>

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

}  // namespace

std::string toMarkdown(const OptionTable& table) {
  std::string out = "| option | default | unit | limits | meaning |\n|---|---|---|---|---|\n";
  for (const OptionField& field : table.fields()) {
    out += fmt::format("| `{}` | {} | {} | {} | {} |\n", field.path, cell(optionText(field)),
                       cell(field.unit), cell(limitsCell(field)), cell(field.help));
  }
  return out;
}

}  // namespace agricolmap::config
