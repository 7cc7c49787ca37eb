// Time per stage of a method, whatever stages it has.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agricolmap/core/monitor.hpp"

namespace agricolmap::experiments {

/// Wall-clock seconds per named stage, in order; a stage entered twice adds up.
class MethodTimes {
 public:
  /// Runs `work` as stage `name` and returns what it returns.
  template <typename Work>
  auto run(std::string_view name, Work&& work) {
    struct Adder {
      MethodTimes* times;
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
  /// Those of the product's chain.
  void add(const Monitor& monitor) {
    for (const StageTime& time : monitor.times()) add(nameOf(time.stage), time.seconds);
  }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace agricolmap::experiments
