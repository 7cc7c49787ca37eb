// Time per stage, and telling someone about it.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace agricolmap {

/// Wall-clock seconds since construction.
class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Seconds per named stage, in order; a stage entered twice adds up.
class StageTimes {
 public:
  using Listener = std::function<void(std::string_view stage)>;
  explicit StageTimes(Listener on_stage = {}) : on_stage_(std::move(on_stage)) {}

  /// Runs `work` as stage `name` and returns what it returns.
  template <typename Work>
  auto run(std::string_view name, Work&& work) {
    if (on_stage_) on_stage_(name);
    struct Adder {
      StageTimes* times;
      std::string_view stage;
      Stopwatch watch;
      ~Adder() { times->add(stage, watch.seconds()); }
    } adder{this, name, {}};
    return std::forward<Work>(work)();
  }
  void add(std::string_view name, double seconds) {
    for (auto& [stage, sum] : stages_) {
      if (stage == name) {
        sum += seconds;
        return;
      }
    }
    stages_.emplace_back(std::string(name), seconds);
  }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  Listener on_stage_;
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace agricolmap
