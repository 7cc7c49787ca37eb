// Work on all cores, with results that do not depend on how many there are.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "agricolmap/core/interrupt.hpp"

#if defined(__SANITIZE_THREAD__)
extern "C" {
void __tsan_acquire(void* address);  // NOLINT(bugprone-reserved-identifier)
void __tsan_release(void* address);  // NOLINT(bugprone-reserved-identifier)
}
#endif

namespace agricolmap {

/// Limits the number of threads for as long as it lives; 0 means all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);

 private:
  tbb::global_control control_;
};

namespace detail {

/// Tells the thread sanitizer what oneTBB guarantees but does, unobserved, in a library of its own:
/// every task begins after the call that made it and ends before that call returns. Nothing is said
/// of two tasks, so their races are found. Empty in other builds.
class ForkJoin {
 public:
#if defined(__SANITIZE_THREAD__)
  ForkJoin() { __tsan_release(&fork_); }
  ~ForkJoin() { __tsan_acquire(&join_); }
  ForkJoin(const ForkJoin&) = delete;
  ForkJoin& operator=(const ForkJoin&) = delete;

  class Task {
   public:
    explicit Task(ForkJoin& call) : call_(call) { __tsan_acquire(&call_.fork_); }
    ~Task() { __tsan_release(&call_.join_); }
    Task(const Task&) = delete;
    Task& operator=(const Task&) = delete;

   private:
    ForkJoin& call_;
  };

 private:
  char fork_ = 0;
  char join_ = 0;
#else
  struct Task {
    explicit Task(const ForkJoin&) {}
  };
#endif
};

/// The one place where a body runs. Inlined into oneTBB's templates it would be compiled several
/// times, with roundings that differ (fused multiply-adds), and which of the copies runs depends on
/// how work is shared out: results would differ from run to run.
template <typename Body>
#if defined(__clang__)
[[gnu::noinline]]
#else
[[gnu::noipa]]
#endif
void runItems(const Body& body, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i != end; ++i) body(i);
}

}  // namespace detail

/// Calls `body(i)` for i in [0, count) from several threads. `body` must only write what belongs to
/// i. Throws Interrupted between items when the StopScope of the caller asks to stop.
template <typename Body>
void parallelFor(std::size_t count, const Body& body, std::size_t grain = 1) {
  detail::ForkJoin call;
  const std::stop_token* const stop = detail::stop_of_thread;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      [[maybe_unused]] const detail::ForkJoin::Task task(call);
                      const detail::StopHandover handover(stop);
                      throwIfInterrupted();
                      detail::runItems(body, range.begin(), range.end());
                    });
}

/// Sums `body(begin, end)` over chunks of fixed size, added in order of the chunks: the same result
/// on any number of threads. `T` needs `+=`; `zero` is its neutral element.
template <typename T, typename Body>
T parallelSum(std::size_t count, std::size_t chunk, const T& zero, const Body& body) {
  const std::size_t chunks = (count + chunk - 1) / chunk;
  std::vector<T> parts(chunks, zero);
  parallelFor(chunks,
              [&](std::size_t i) { parts[i] = body(i * chunk, std::min(count, (i + 1) * chunk)); });
  T sum = zero;
  for (const T& part : parts) sum += part;
  return sum;
}

}  // namespace agricolmap
