// Options as a part of a YAML document, for files that have more than options.
#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <map>
#include <string>

#include "agricolmap/core/options.hpp"

namespace agricolmap::config {

/// What options are set to, by their paths.
using OptionTexts = std::map<std::string, std::string>;
/// Hears what is wrong, and in which line.
using OnProblem = std::function<void(int line, const std::string& what)>;

/// Line of a node, counted from 1; of an empty document, 1.
int lineOf(const YAML::Node& node);

/// The one document of `text`. Throws UsageError, with `name` for the file and the line, where it
/// is no YAML or not the only one; `what`: what the file is, with a remedy.
YAML::Node parseYaml(const std::string& text, const std::string& name, const std::string& what);

/// The options of a map of them, each checked against `table`; of those that are unknown, given
/// twice, of wrong types or outside their limits `on_problem` hears, and they are left out.
OptionTexts readOptions(const YAML::Node& map, const OptionTable& table,
                        const OnProblem& on_problem);

/// Sets them all. Throws UsageError as parseOption does; nothing is changed then.
void applyOptions(const OptionTexts& texts, const OptionTable& table);

}  // namespace agricolmap::config
