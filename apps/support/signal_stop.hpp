// SIGINT and SIGTERM as a stop token. For programs: signals belong to the process, not to a
// library.
#pragma once

#include <stop_token>
#include <thread>

namespace agricolmap {

/// At most one at a time. While it lives, the first SIGINT or SIGTERM asks its token to stop; a
/// second one ends the process as usual.
class SignalStop {
 public:
  SignalStop();
  ~SignalStop();
  SignalStop(const SignalStop&) = delete;
  SignalStop& operator=(const SignalStop&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  int wake_[2] = {-1, -1};  ///< the signal handler writes to the second, `waiter_` reads the first
  std::thread waiter_;
};

}  // namespace agricolmap
