// From what the pipeline found to what callers get.
#pragma once

#include <string>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/register.hpp"

namespace agricolmap {

/// How it was asked for.
struct Asked {
  Transform guess = Transform::Identity();
  pipeline::RegistrationOptions options;  ///< in force
  std::string preset;
  int threads = 0;
};

/// With what reports and pictures are made from. The clouds need not outlive it.
Registration finished(const Cloud& fixed, const Cloud& moving, pipeline::Registration found,
                      const Asked& asked, const Monitor& monitor);

/// Refuses what was changed in vain, so that nobody believes it to have acted; the options in
/// force. Throws UsageError.
pipeline::RegistrationOptions optionsInForce(const Options& options);

/// What enters stages, as the caller wants to follow them.
Monitor monitorFor(const Control& control);

}  // namespace agricolmap
