// How far a campaign is, on a terminal's stderr.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "agricolmap/core/stopwatch.hpp"
#include "experiments/runner/plan.hpp"

namespace agricolmap::experiments {

/// One line, in place; nothing where stderr is no terminal. Not for several threads at once.
class Progress {
 public:
  Progress(const CampaignScope& scope, const std::vector<Job>& jobs, int at_a_time,
           const RowTable& table);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is being worked on.
  void now(const std::string& case_name, int seed);
  void done(const Row& row);

 private:
  /// Mean time of what has been done, earlier runs included, and what is left.
  struct Work {
    double seconds = 0.0;
    int done = 0;
    int left = 0;
  };
  void count(const Row& row);
  void print() const;
  std::string timeLeft() const;

  std::map<std::string, Work> runs_;  ///< by method
  Work pairs_;                        ///< making them
  int at_a_time_;
  std::string place_;
  bool terminal_;
};

}  // namespace agricolmap::experiments
