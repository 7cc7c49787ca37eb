#include "agricolmap/batch/pool.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "agricolmap/batch/memory.hpp"

namespace agricolmap::batch {
namespace {

constexpr auto kWork = std::chrono::milliseconds(15);
constexpr auto kLook = std::chrono::milliseconds(1);

/// Notes what runs, and how many at once.
class Trace {
 public:
  void run(std::size_t i) {
    {
      const std::scoped_lock lock(mutex_);
      begun_.push_back(i);
      most_ = std::max(most_, ++running_);
    }
    std::this_thread::sleep_for(kWork);
    --running_;
  }
  const std::vector<std::size_t>& begun() const { return begun_; }
  int most() const { return most_; }
  int running() const { return running_; }

 private:
  std::mutex mutex_;
  std::vector<std::size_t> begun_;
  std::atomic<int> running_ = 0;
  int most_ = 0;
};

PoolWork workOf(Trace& trace, std::size_t count, double each) {
  return {count, [each](std::size_t) { return each; }, [] { return 0.0; },
          [&trace](std::size_t i) { trace.run(i); }};
}

TEST(Pool, DoesEachItemOnceWithAsManyAtOnceAsAllowed) {
  for (const std::size_t jobs : {1, 3}) {
    Trace trace;
    runPool(workOf(trace, 20, 1.0), {jobs, 100.0, kLook}, {});
    std::vector<std::size_t> done = trace.begun();
    std::sort(done.begin(), done.end());
    ASSERT_EQ(done.size(), 20U);
    for (std::size_t i = 0; i < done.size(); ++i) EXPECT_EQ(done[i], i);
    EXPECT_EQ(trace.most(), static_cast<int>(jobs));
  }
}

TEST(Pool, RunsNoMoreAtOnceThanFitIntoMemory) {
  Trace trace;
  PoolWork work = workOf(trace, 12, 10.0);
  work.memory_in_use = [&] { return 10.0 * trace.running(); };  // as was thought
  runPool(work, {8, 35.0, kLook}, {});
  EXPECT_EQ(trace.begun().size(), 12U);
  EXPECT_LE(trace.most(), 3);
  EXPECT_GE(trace.most(), 2);
}

TEST(Pool, RunsWhatIsTooLargeAlone) {
  Trace trace;
  runPool(workOf(trace, 5, 100.0), {4, 10.0, kLook}, {});
  EXPECT_EQ(trace.begun().size(), 5U);
  EXPECT_EQ(trace.most(), 1);
}

TEST(Pool, LearnsFromWhatItemsTake) {
  // Thought to need 10, they need 1.
  Trace trace;
  PoolWork work = workOf(trace, 60, 10.0);
  work.memory_in_use = [&] { return 1.0 * trace.running(); };
  runPool(work, {6, 12.0, kLook}, {});
  EXPECT_EQ(trace.begun().size(), 60U);
  EXPECT_GT(trace.most(), 3);
  // Thought to need 1, they need 10.
  Trace other;
  std::atomic<int> late = 0;
  PoolWork heavy = workOf(other, 60, 1.0);
  heavy.memory_in_use = [&] { return 10.0 * other.running(); };
  heavy.work = [&](std::size_t i) {
    other.run(i);
    if (i > 40) late = std::max<int>(late, other.running());
  };
  runPool(heavy, {6, 26.0, kLook}, {});
  EXPECT_EQ(other.begun().size(), 60U);
  EXPECT_LE(late, 2);
}

TEST(Pool, BeginsNothingAfterAStopWasAskedFor) {
  Trace trace;
  std::stop_source source;
  PoolWork work = workOf(trace, 50, 1.0);
  work.work = [&](std::size_t i) {
    trace.run(i);
    if (i == 4) source.request_stop();
  };
  runPool(work, {2, 100.0, kLook}, source.get_token());
  EXPECT_GE(trace.begun().size(), 5U);
  EXPECT_LE(trace.begun().size(), 8U);
  EXPECT_EQ(trace.running(), 0);
}

TEST(Pool, NeedsNoItems) {
  Trace trace;
  runPool(workOf(trace, 0, 1.0), {2, 1.0, kLook}, {});
  EXPECT_TRUE(trace.begun().empty());
}

TEST(Memory, IsToldByTheSystem) {
  EXPECT_GT(availableMemory(), 1e7);
  const double before = memoryInUse();
  EXPECT_GT(before, 1e5);
  const std::vector<char> much(std::size_t{1} << 27, 'x');
  EXPECT_GT(memoryInUse(), before + 0.9 * static_cast<double>(much.size()));
}

}  // namespace
}  // namespace agricolmap::batch
