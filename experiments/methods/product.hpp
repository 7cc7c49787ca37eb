// The product's own chains as methods of the comparison.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "agricolmap/pipeline/options.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {

/// `agricolmap`, its variants by data term, and `default`.
std::vector<std::string> productNames();
/// nullptr for a name that is none of them.
std::unique_ptr<Method> makeProduct(const std::string& name);

/// Fills `outcome` from what the pipeline found; `accepted` is its verdict.
void fillFrom(const pipeline::Registration& result, const MethodInput& input,
              MethodOutcome& outcome);

}  // namespace agricolmap::experiments
