// Where the scale of the moving file is not known at all, as of a map from one moving camera
// (structure from motion): the factors that are tried before anything else.
#pragma once

#include <vector>

#include "agricolmap/locate/association.hpp"
#include "agricolmap/map/grid_map.hpp"

namespace agricolmap::pipeline {

/// Factors from 0.1 to 10 such that what lies between them is within the scales that a search
/// covers, nearest to 1 first; then those half way between, for files whose two axes differ.
/// Factors at which a moving map of these bounds would be too large for the fixed map, or too small
/// to hold anything that could be recognised, are left out.
std::vector<double> scaleFactors(const map::Box2& moving, const map::Box2& fixed,
                                 const PriorUncertainty& uncertainty);

}  // namespace agricolmap::pipeline
