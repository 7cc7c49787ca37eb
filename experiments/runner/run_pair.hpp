// Registers one pair of a campaign and makes a row of what came of it.
#pragma once

#include <string>

#include "agricolmap/pipeline/options.hpp"
#include "campaign_cases.hpp"
#include "campaign_table.hpp"
#include "pair_maker.hpp"

namespace agricolmap::experiments {

/// Whether the registration can be told that the moving file's unit is unknown.
bool knowsScaleUnknown();

/// The options of `preset` or `preset:key=value:key=value`, told what the case says about its
/// guess. Throws UsageError for unknown ones.
pipeline::RegistrationOptions variant(const std::string& text, const Case& chosen);

/// The flow starts from a guess: it cannot search everywhere or for a scale.
bool canRegister(const std::string& preset_name, const Case& chosen);

/// The row of `pair` but for the case's name, the seed and what making the pair cost.
PairRow registerPair(const Pair& pair, const std::string& preset_name,
                     const Case& chosen);

}  // namespace agricolmap::experiments
