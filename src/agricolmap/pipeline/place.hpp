// The method on the maps of a pair, from placements on: registration.cpp has it as a whole. What
// places a strip otherwise, by its pieces or at any scale, is made of these.
#pragma once

#include <optional>
#include <vector>

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// Both maps made comparable.
refine::PairSignals signalsOf(const correlation::MapSignals& fixed,
                              const correlation::MapSignals& moving,
                              const RegistrationOptions& options, Monitor& monitor);

/// From placements to an answer: refine (Eq. 3 and Sec. IV, or densely), heights, verdict.
/// `rivals`: other places that are known already; nothing: those that hold when refined.
Outcome settle(const PairMaps& maps, const refine::PairSignals& signals, Located located,
               std::optional<std::vector<refine::RefinedPose>> rivals,
               const RegistrationOptions& options, Monitor& monitor);

/// Locates and settles, and searches anew, more finely and freely, what is not accepted. `most`:
/// searches.
Outcome place(const PairMaps& maps, const correlation::MapSignals& fixed, std::size_t most,
              const RegistrationOptions& options, const Locator& locator, Monitor& monitor);

}  // namespace agricolmap::pipeline
