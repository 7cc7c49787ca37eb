// Work on all cores, with results that do not depend on how many there are.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include "agricolmap/core/interrupt.hpp"

namespace agricolmap {

/// Limits the number of threads for as long as it lives; 0 means all cores.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);

 private:
  tbb::global_control control_;
};

/// Calls `body(i)` for i in [0, count) from several threads. `body` must only write what belongs to
/// i. Throws Interrupted between items when the user asked to stop.
template <typename Body>
void parallelFor(std::size_t count, const Body& body, std::size_t grain = 1) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      throwIfInterrupted();
                      for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
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
