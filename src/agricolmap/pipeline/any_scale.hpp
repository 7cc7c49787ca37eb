// Placing a strip whose file is in unknown units.
#pragma once

#include <utility>

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// At a scale that is not known: one search at each factor that the moving file may be off by, then
/// anew from what the best of them found, with heights at the right scale and cells of the right
/// size. `maps` are left as at that scale, which is returned, too.
std::pair<Outcome, double> placeAtAnyScale(const FixedCloud& fixed, const Cloud& moving,
                                           const Eigen::Affine3d& guess,
                                           const RegistrationOptions& options,
                                           const Locator& locator, Monitor& monitor,
                                           PairMaps& maps);

}  // namespace agricolmap::pipeline
