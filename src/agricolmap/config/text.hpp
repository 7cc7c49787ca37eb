// Options as text: what files and the command line share.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/core/options.hpp"

namespace agricolmap::config {

/// The value as YAML and the command line write it; parseOption reads back the same bits.
std::string optionText(const OptionField& field);

/// What values are allowed: `0.005 to 1`, `plain or chromatic`, `true or false`.
std::string limitsText(const OptionField& field);

/// Checks `text` against the type and limits of `field` and returns what sets the value, so that a
/// caller can check everything before changing anything. Throws UsageError naming the option.
std::function<void()> parseOption(const OptionField& field, std::string_view text);

/// Whether the table has options of both levels, so that it helps to tell them apart.
bool hasLevels(const OptionTable& table);

/// The path that was most likely meant by an unknown one; empty when none is near.
std::string closestPath(const OptionTable& table, std::string_view path);

/// ` (did you mean 'grid.cell'?)` or, when none is near, nothing.
std::string suggestion(const OptionTable& table, std::string_view path);
/// The same of a word among known ones.
std::string suggestion(const std::vector<std::string>& known, std::string_view word);

}  // namespace agricolmap::config
