// Stopping half-way when the caller asks for it. The request is a std::stop_token that belongs to
// one call, so that two registrations of one process can be stopped apart.
#pragma once

#include <stop_token>
#include <utility>

#include "agricolmap/core/error.hpp"

namespace agricolmap {
namespace detail {

/// Of the work that the calling thread is doing; nullptr: nobody can stop it.
inline thread_local const std::stop_token* stop_of_thread = nullptr;

/// For as long as it lives, the calling thread works for whoever holds this token.
class StopHandover {
 public:
  explicit StopHandover(const std::stop_token* stop) : before_(stop_of_thread) {
    stop_of_thread = stop;
  }
  ~StopHandover() { stop_of_thread = before_; }
  StopHandover(const StopHandover&) = delete;
  StopHandover& operator=(const StopHandover&) = delete;

 private:
  const std::stop_token* before_;
};

}  // namespace detail

/// Until it ends, what the calling thread does can be stopped by the token, and so can the parallel
/// work that it starts.
class StopScope {
 public:
  explicit StopScope(std::stop_token stop) : stop_(std::move(stop)), handover_(&stop_) {}

 private:
  std::stop_token stop_;
  detail::StopHandover handover_;
};

/// Throws Interrupted once the token of the scope that this is called in asks to stop. Cheap: call
/// it in every long loop.
inline void throwIfInterrupted() {
  if (detail::stop_of_thread != nullptr && detail::stop_of_thread->stop_requested()) {
    throw Interrupted();
  }
}

}  // namespace agricolmap
