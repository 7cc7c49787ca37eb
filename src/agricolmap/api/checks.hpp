// What is looked at before any work on behalf of a caller.
#pragma once

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/register.hpp"

namespace agricolmap {

/// What readers of files see to, and callers with points of their own may have missed. Throws
/// InputError.
void requireWhole(const Cloud& cloud);

/// Throws UsageError for a negative number of threads.
ThreadLimit threadLimit(const Control& control);

}  // namespace agricolmap
