#include "agricolmap/3_describe/huge_vector.hpp"

#include <map>
#include <mutex>
#include <new>
#include <unordered_map>

namespace agricolmap {

namespace {

constexpr std::align_val_t kLine{64};
constexpr std::size_t kHuge = std::size_t{1} << 21;  ///< from here on blocks are kept

struct Store {
  std::mutex mutex;
  int keepers = 0;
  std::multimap<std::size_t, void*> kept;         ///< by size
  std::unordered_map<void*, std::size_t> in_use;  ///< their sizes, which may exceed what was asked
};

Store& store() {
  static Store instance;
  return instance;
}

void release(void* memory) { ::operator delete(memory, kLine); }

}  // namespace

KeepHugeMemory::KeepHugeMemory() {
  const std::lock_guard lock(store().mutex);
  ++store().keepers;
}

KeepHugeMemory::~KeepHugeMemory() {
  const std::lock_guard lock(store().mutex);
  if (--store().keepers > 0) return;
  for (const auto& [size, memory] : store().kept) release(memory);
  store().kept.clear();
}

namespace detail {

void* allocateHuge(std::size_t bytes) {
  if (bytes < kHuge) return ::operator new(bytes, kLine);
  const std::lock_guard lock(store().mutex);
  const auto fits = store().kept.lower_bound(bytes);
  if (fits != store().kept.end()) {
    void* memory = fits->second;
    store().in_use[memory] = fits->first;
    store().kept.erase(fits);
    return memory;
  }
  void* memory = ::operator new(bytes, kLine);
  store().in_use[memory] = bytes;
  return memory;
}

void freeHuge(void* memory, std::size_t bytes) {
  if (bytes < kHuge) return release(memory);
  const std::lock_guard lock(store().mutex);
  const auto used = store().in_use.find(memory);
  if (store().keepers > 0) {
    store().kept.emplace(used->second, memory);
  } else {
    release(memory);
  }
  store().in_use.erase(used);
}

}  // namespace detail

}  // namespace agricolmap
