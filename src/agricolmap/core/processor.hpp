// Whether this machine can run what the compiler made.
#pragma once

namespace agricolmap {

/// Throws Error when the processor lacks instructions that the build counts on.
void requireProcessor();

}  // namespace agricolmap
