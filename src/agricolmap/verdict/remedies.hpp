// What its users can do about a registration that was not accepted, from what failed on their pair.
#pragma once

#include <string>
#include <vector>

#include "agricolmap/verdict/verdict.hpp"

namespace agricolmap::verdict {

/// Most promising first, in plain words, with lengths where the pair says how much is needed: a
/// strip's peak grows with the root of its area, and the highest wrong one hardly. Empty for an
/// accepted registration.
std::vector<std::string> remediesFor(const Verdict& verdict, const Finding& finding,
                                     const SearchSpace& space, const VerdictOptions& options);

/// For a pair in which nothing was found that holds.
std::vector<std::string> remediesForNothing(const SearchSpace& space);

}  // namespace agricolmap::verdict
