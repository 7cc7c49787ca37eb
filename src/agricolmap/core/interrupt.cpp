#include "agricolmap/core/interrupt.hpp"

#include <atomic>
#include <csignal>

#include "agricolmap/core/error.hpp"

namespace agricolmap {
namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "needed in a signal handler");

void onSignal(int signal) {
  if (requested.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

}  // namespace

void installInterruptHandler() {
  struct sigaction action {};
  action.sa_handler = onSignal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interruptRequested() noexcept { return requested.load(std::memory_order_relaxed); }

void requestInterrupt(bool on) noexcept { requested.store(on); }

void throwIfInterrupted() {
  if (interruptRequested()) throw Interrupted();
}

}  // namespace agricolmap
