#include "agricolmap/version.hpp"

namespace agricolmap {

const char* version() { return AGRICOLMAP_VERSION; }

}  // namespace agricolmap
