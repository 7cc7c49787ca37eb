// Which of several answers about the same maps is kept.
#pragma once

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::pipeline {

/// True when `a` is to be preferred to `b`: accepted first, then ambiguous, then more probable.
bool better(const Outcome& a, const Outcome& b);
/// True when the outcome of a later search replaces an earlier one of the same maps. Places that
/// could not be told apart are not forgotten because a later search misses some of them: after an
/// ambiguous outcome counts only a place that none of them rivals (`VerdictOptions::rival`).
bool supersedes(const Outcome& later, const Outcome& earlier, double rival);

}  // namespace agricolmap::pipeline
