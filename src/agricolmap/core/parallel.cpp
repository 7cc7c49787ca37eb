#include "agricolmap/core/parallel.hpp"

#include <tbb/info.h>

namespace agricolmap {

ThreadLimit::ThreadLimit(int threads)
    : control_(tbb::global_control::max_allowed_parallelism,
               static_cast<std::size_t>(
                   threads > 0 ? threads : std::max(1, tbb::info::default_concurrency()))) {}

}  // namespace agricolmap
