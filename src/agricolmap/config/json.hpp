// Options as JSON, for reports.
#pragma once

#include <nlohmann/json.hpp>

#include "agricolmap/core/options.hpp"

namespace agricolmap::config {

/// All options with their values, groups as nested objects, in order of declaration.
nlohmann::ordered_json toJson(const OptionTable& table);

}  // namespace agricolmap::config
