// Options from and to YAML: nested maps are the dots of the options' paths.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "agricolmap/core/options.hpp"

namespace agricolmap::config {

/// Sets the options that the file names; the others keep their values. Throws InputError when the
/// file cannot be read and UsageError, with file, line and remedy, for unknown keys (naming the
/// closest known one), keys given twice, wrong types and values outside their limits; nothing is
/// changed then. Returns the paths that were set.
std::vector<std::string> loadYaml(const std::filesystem::path& file, OptionTable& table);

/// The same for text; `name` stands for the file in messages.
std::vector<std::string> loadYamlText(const std::string& text, const std::string& name,
                                      OptionTable& table);

/// All options with their values, each under a comment with unit, limits and help, which says
/// which are advanced where there are others, too. loadYaml reads back the same values.
std::string dumpYaml(const OptionTable& table);

}  // namespace agricolmap::config
