#include "support/signal_stop.hpp"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace agricolmap {
namespace {

// All that a signal handler may touch: std::stop_source is not among it.
std::atomic<int> wake_fd{-1};
std::atomic<bool> signalled{false};
static_assert(std::atomic<int>::is_always_lock_free, "needed in a signal handler");

constexpr char kStop = 's';
constexpr char kQuit = 'q';

void onSignal(int signal) {
  const int error = errno;
  if (signalled.exchange(true)) {
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
  // Nothing can be done where this fails; the next signal kills.
  [[maybe_unused]] const auto written = write(wake_fd.load(), &kStop, 1);
  errno = error;
}

void handleSignals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

SignalStop::SignalStop() {
  if (pipe(wake_) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  waiter_ = std::thread([this] {
    char why = kQuit;
    while (read(wake_[0], &why, 1) < 0 && errno == EINTR) {
    }
    if (why == kStop) source_.request_stop();
  });
  // A file that grows beyond what the shell allows is an error like that of a full disk.
  std::signal(SIGXFSZ, SIG_IGN);
  signalled = false;
  wake_fd = wake_[1];
  handleSignals(onSignal);
}

SignalStop::~SignalStop() {
  handleSignals(SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  wake_fd = -1;
  [[maybe_unused]] const auto written = write(wake_[1], &kQuit, 1);
  waiter_.join();
  close(wake_[0]);
  close(wake_[1]);
}

}  // namespace agricolmap
