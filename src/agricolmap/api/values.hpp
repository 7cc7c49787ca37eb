// What the public Options stand for.
#pragma once

#include <string>

#include "agricolmap/options.hpp"
#include "agricolmap/pipeline/options.hpp"

namespace agricolmap {

struct Options::Values {
  pipeline::RegistrationOptions options;
  std::string preset;  ///< that they started from
};

}  // namespace agricolmap
