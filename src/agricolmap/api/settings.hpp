// Options that come as names and texts.
#pragma once

#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"
#include "agricolmap/field.hpp"

namespace agricolmap {

/// The field of that name. Throws UsageError, with the name that was probably meant.
const OptionField& fieldOf(const OptionTable& table, std::string_view name);

/// All options of the table.
std::vector<OptionInfo> infosOf(const OptionTable& table);

/// Throws UsageError when the value is outside its limits.
void setOption(const OptionField& field, std::string_view value);

/// The defaults, changed. Throws UsageError.
template <typename Chosen>
Chosen chosen(const Settings& settings) {
  Chosen options;
  const OptionTable table = optionTable(options);
  for (const auto& [name, value] : settings) setOption(fieldOf(table, name), value);
  return options;
}

}  // namespace agricolmap
