// Options as a Markdown table, for the documentation.
#pragma once

#include <string>

#include "agricolmap/core/options.hpp"

namespace agricolmap::config {

/// One row per option: name, value, unit, limits, meaning. Where the table has options of both
/// levels, first the basic ones, then all of them, group by group under `###` headings. Give a
/// table over default options to document the defaults.
std::string toMarkdown(const OptionTable& table);

}  // namespace agricolmap::config
