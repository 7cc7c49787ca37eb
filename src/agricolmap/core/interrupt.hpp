// Stopping half-way when the user asks for it.
#pragma once

namespace agricolmap {

/// Makes SIGINT and SIGTERM set a flag instead of killing the process; a second one kills.
void installInterruptHandler();

/// True once a signal has come (or requestInterrupt was called).
bool interruptRequested() noexcept;

/// Sets or clears the flag, for embedding programs and tests.
void requestInterrupt(bool on = true) noexcept;

/// Throws Interrupted once the flag is set. Cheap: call it in every long loop.
void throwIfInterrupted();

}  // namespace agricolmap
