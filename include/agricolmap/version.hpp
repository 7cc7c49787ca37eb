// Which version this is.
#pragma once

#include "agricolmap/export.hpp"

namespace agricolmap {

/// Version of the library that runs, e.g. "1.0.0".
AGRICOLMAP_EXPORT const char* version();

}  // namespace agricolmap
