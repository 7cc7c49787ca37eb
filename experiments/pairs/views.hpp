// How pairs of the comparison differ from one another: plants, light, sensors and path, drawn
// anew for each.
#pragma once

#include <vector>

#include "experiments/pairs/suite.hpp"

namespace agricolmap::experiments {

/// From the crops' usual settings to the project's hard views and beyond. Real imagery keeps its
/// plants and its light as they were at the flight; only the second sensor's differ. kDevelop and
/// kFinal span the same and have no value in common; there are no others.
std::vector<OptionRange> viewRanges(Settings settings, PairSource source);

}  // namespace agricolmap::experiments
