#include "agricolmap/batch/pool.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

namespace agricolmap::batch {
namespace {

/// Estimates are believed, and only corrected upwards, until so many items are done.
constexpr std::size_t kFirst = 3;
constexpr double kMargin = 1.25;      ///< on what was measured
constexpr double kLeastFactor = 0.2;  ///< no item is believed to need less of what was thought

class Pool {
 public:
  Pool(const PoolWork& work, const PoolLimits& limits, std::stop_token stop)
      : work_(work), limits_(limits), stop_(std::move(stop)), before_(work.memory_in_use()) {}

  void run() {
    const std::size_t threads = std::min(limits_.jobs, work_.count);
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < threads; ++i) workers.emplace_back([this] { workerLoop(); });
    watch();
  }

 private:
  void workerLoop() {
    while (const auto item = begin()) {
      work_.work(item->index);
      const std::scoped_lock lock(mutex_);
      running_ -= item->estimate;
      --running_count_;
      ++done_;
      changed_.notify_all();
    }
    const std::scoped_lock lock(mutex_);
    ++left_;
    changed_.notify_all();
  }

  struct Item {
    std::size_t index = 0;
    double estimate = 0.0;
  };

  /// Waits until the next item may run; nothing when there is none.
  std::optional<Item> begin() {
    std::unique_lock lock(mutex_);
    while (true) {
      if (next_ >= work_.count || stop_.stop_requested()) return std::nullopt;
      const double estimate = work_.estimate(next_);
      if (running_count_ == 0 || fits(running_ + estimate)) {
        running_ += estimate;
        ++running_count_;
        return Item{next_++, estimate};
      }
      changed_.wait_for(lock, limits_.between_looks);  // a stop tells nobody
    }
  }

  bool fits(double estimate) const {
    const double factor = std::max(done_ < kFirst ? 1.0 : kLeastFactor, measured_);
    return before_ + factor * estimate <= limits_.memory;
  }

  /// Looks at the memory while the items run: what they took of what was thought, at the most.
  void watch() {
    std::unique_lock lock(mutex_);
    const std::size_t threads = std::min(limits_.jobs, work_.count);
    while (!changed_.wait_for(lock, limits_.between_looks, [&] { return left_ == threads; })) {
      if (running_ <= 0.0) continue;
      const double taken = std::max(0.0, work_.memory_in_use() - before_);
      measured_ = std::max(measured_, kMargin * taken / running_);
    }
  }

  const PoolWork& work_;
  const PoolLimits& limits_;
  std::stop_token stop_;
  double before_;  ///< memory that was in use at the beginning [bytes]
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0;
  std::size_t running_count_ = 0;
  std::size_t done_ = 0;
  std::size_t left_ = 0;   ///< threads that have no more to do
  double running_ = 0.0;   ///< estimates of what runs [bytes]
  double measured_ = 0.0;  ///< how much was taken of what was estimated
};

}  // namespace

void runPool(const PoolWork& pool, const PoolLimits& limits, std::stop_token stop) {
  if (pool.count > 0) Pool(pool, limits, std::move(stop)).run();
}

}  // namespace agricolmap::batch
