// Many pieces of work on a few threads, as many at once as memory allows.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>

namespace agricolmap::batch {

struct PoolLimits {
  std::size_t jobs = 1;  ///< at once, at most
  double memory = 0.0;   ///< that all of them may take [bytes]; one is always let run
  std::chrono::milliseconds between_looks{100};  ///< at the memory in use
};

/// What the pool asks and does. All but `work` are called by one thread at a time.
struct PoolWork {
  std::size_t count = 0;
  /// Memory that item i may need at its peak [bytes], guessed; corrected by what is measured.
  std::function<double(std::size_t i)> estimate;
  std::function<double()> memory_in_use;  ///< by the process, now [bytes]
  /// Must not throw. Called from several threads.
  std::function<void(std::size_t i)> work;
};

/// Works through the items in order, each on a thread of its own. After a stop is asked for none is
/// begun; those that run are waited for.
void runPool(const PoolWork& pool, const PoolLimits& limits, std::stop_token stop);

}  // namespace agricolmap::batch
