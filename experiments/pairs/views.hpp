// How the pairs of the comparison differ from one another: plants, light, sensors and path, drawn
// anew for each.
#pragma once

#include <string>
#include <vector>

#include "experiments/pairs/cases.hpp"

namespace agricolmap::experiments {

/// Two disjoint halves of the settings: what methods are improved on is not what is reported.
enum class Views { kDevelop, kFinal };

/// "develop", "final".
std::vector<std::string> viewNames();
/// Throws UsageError, listing the known names, for an unknown one.
Views parseViews(const std::string& name);
std::string toString(Views views);

/// From the crops' usual settings to the project's hard views and beyond. Real imagery keeps its
/// plants and its light as they were at the flight; only the second sensor's differ.
std::vector<OptionRange> viewRanges(Views views, PairSource source);

}  // namespace agricolmap::experiments
