// The product's presets as methods.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// The presets, and those that the paper's Tab. IV compares.
std::vector<std::string> productNames();
/// A preset or `PRESET:KEY=VALUE:…`, which changes its options. Nothing for a name that does not
/// begin with a preset. Throws UsageError for a setting that no option takes.
std::optional<Method> makeProduct(const std::string& name);

/// Fills `outcome` from what the pipeline found, but for the times; `accepted` is its verdict.
void fillFrom(const pipeline::Registration& result, const MethodInput& input,
              MethodOutcome& outcome);

}  // namespace agricolmap::experiments
