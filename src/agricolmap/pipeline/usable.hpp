// What cannot be registered, said before any work is done.
#pragma once

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/pipeline/options.hpp"

namespace agricolmap::pipeline {

/// Throws InputError for clouds that lack what the options compare, UsageError for a search that
/// cannot be as wide as the guess leaves it. `located_otherwise`: not by the options' search.
void requireUsable(const CloudFacts& fixed, const CloudFacts& moving,
                   const RegistrationOptions& options, bool located_otherwise);

/// That a search took more work than it is meant to, and what would spare it.
std::string workExceeded(const locate::SearchReport& report,
                         const locate::CorrelationOptions& options);

/// Warns when one of the maps has no heights to compare, as an orthomosaic laid flat: then colours
/// alone are, and the heights of the result are those of the ground planes.
void warnOfFlat(const map::GridMap& fixed, const map::GridMap& moving,
                const map::SignalOptions& signal, Monitor& monitor);

/// Why a moving file of unknown scale was not even looked for.
InputError fitsAtNoScale(const CloudFacts& fixed, const Cloud& moving);

}  // namespace agricolmap::pipeline
