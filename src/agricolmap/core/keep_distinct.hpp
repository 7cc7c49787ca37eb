// Non-maximum suppression: of many answers that are nearly the same, the best one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace agricolmap {

/// Of a list sorted best first: in order, each that is the same as none kept before it by
/// `same(better, one)`, until there are `most`. Takes time in proportion to the list's length times
/// the number that is kept.
template <typename T, typename Same>
std::vector<T> keepDistinct(std::vector<T> sorted, const Same& same,
                            std::size_t most = std::numeric_limits<std::size_t>::max()) {
  std::vector<T> kept;
  for (T& one : sorted) {
    if (kept.size() >= most) break;
    const bool known =
        std::any_of(kept.begin(), kept.end(), [&](const T& better) { return same(better, one); });
    if (!known) kept.push_back(std::move(one));
  }
  return kept;
}

}  // namespace agricolmap
