// What a long call and its caller tell one another while it runs: time per stage, progress,
// warnings, and the wish to stop.
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/stage.hpp"
#include "agricolmap/core/stopwatch.hpp"

namespace agricolmap {

/// Wall-clock seconds of one stage.
struct StageTime {
  Stage stage = Stage::kRead;
  double seconds = 0.0;
};

/// For one call at a time; stages are entered from the thread that runs the call.
class Monitor {
 public:
  using Listener = std::function<void(Stage)>;

  Monitor() = default;
  explicit Monitor(std::stop_token stop, Listener on_stage = {})
      : stop_(std::move(stop)), on_stage_(std::move(on_stage)) {}

  const std::stop_token& stop() const { return stop_; }

  /// Runs `work` as a stage and returns what it returns. A stage that is entered within another
  /// one interrupts it: every moment counts for the innermost stage alone, so that stages add up.
  template <typename Work>
  auto run(Stage stage, Work&& work) {
    const Entered entered(*this, stage);
    return std::forward<Work>(work)();
  }

  /// Per stage, in the order in which they were first entered.
  const std::vector<StageTime>& times() const { return times_; }
  /// Seconds since the monitor was made: what the stages add up to, but for what is between them.
  double seconds() const { return watch_.seconds(); }

  /// What the caller should know though the call went on.
  void warn(std::string text) { warnings_.push_back(std::move(text)); }
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  class Entered {
   public:
    Entered(Monitor& monitor, Stage stage) : monitor_(monitor), outer_(monitor.current_) {
      monitor_.settle();
      monitor_.current_ = monitor_.indexOf(stage);
      if (monitor_.on_stage_) monitor_.on_stage_(stage);
    }
    ~Entered() {
      monitor_.settle();
      monitor_.current_ = outer_;
    }
    Entered(const Entered&) = delete;
    Entered& operator=(const Entered&) = delete;

   private:
    Monitor& monitor_;
    std::size_t outer_;
  };
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  std::size_t indexOf(Stage stage) {
    for (std::size_t i = 0; i < times_.size(); ++i) {
      if (times_[i].stage == stage) return i;
    }
    times_.push_back({stage, 0.0});
    return times_.size() - 1;
  }
  /// Gives the current stage the time since it was last looked at.
  void settle() {
    const double now = watch_.seconds();
    if (current_ != kNone) times_[current_].seconds += now - since_;
    since_ = now;
  }

  std::stop_token stop_;
  Listener on_stage_;
  Stopwatch watch_;
  std::vector<StageTime> times_;
  std::vector<std::string> warnings_;
  std::size_t current_ = kNone;
  double since_ = 0.0;
};

}  // namespace agricolmap
