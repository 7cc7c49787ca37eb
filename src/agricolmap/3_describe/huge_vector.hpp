// Arrays of tens of megabytes: where they lie, and their use again and again.
#pragma once

#include <cstddef>
#include <vector>

namespace agricolmap {

/// While one lives, the memory of HugeVectors is kept when they end, for those that follow: fresh
/// pages cost more time than what is computed in them. Calls from several threads are safe.
class KeepHugeMemory {
 public:
  KeepHugeMemory();
  ~KeepHugeMemory();
  KeepHugeMemory(const KeepHugeMemory&) = delete;
  KeepHugeMemory& operator=(const KeepHugeMemory&) = delete;
};

namespace detail {
void* allocateHuge(std::size_t bytes);
void freeHuge(void* memory, std::size_t bytes);
}  // namespace detail

/// Memory that starts at a cache line.
template <typename T>
struct HugeAllocator {
  using value_type = T;

  HugeAllocator() = default;
  template <typename U>
  explicit(false) HugeAllocator(const HugeAllocator<U>& /*other*/) {}

  T* allocate(std::size_t count) {
    return static_cast<T*>(detail::allocateHuge(count * sizeof(T)));
  }
  void deallocate(T* memory, std::size_t count) { detail::freeHuge(memory, count * sizeof(T)); }
  friend bool operator==(const HugeAllocator& /*a*/, const HugeAllocator& /*b*/) { return true; }
};

template <typename T>
using HugeVector = std::vector<T, HugeAllocator<T>>;

}  // namespace agricolmap
