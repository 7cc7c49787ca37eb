// Which pieces of a long strip are looked for as if they were all there is.
#pragma once

#include <vector>

#include "agricolmap/deform/path.hpp"
#include "agricolmap/map/signal_map.hpp"

namespace agricolmap::pieces {

/// Where along the path a piece of this `length` is looked for first, second and so on [m]: pieces
/// that show much before others, and of these, with `middle_first`, those in the middle, which a
/// wrong heading and scale of the guess move least.
std::vector<double> anchorsOf(const deform::Path& path, const map::SignalMap& signals,
                              double length, bool middle_first);

}  // namespace agricolmap::pieces
