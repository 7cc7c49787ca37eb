// What happened on the way to an answer, as names and numbers for people.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::report {

/// How many things each stage had, in order; described in docs/registration-json.md.
std::vector<std::pair<std::string, double>> countsOf(const pipeline::Registration& registration);

/// The placement that the answer was refined from. Requires `registration.placed`.
const Placement& winnerOf(const pipeline::Registration& registration);

}  // namespace agricolmap::report
