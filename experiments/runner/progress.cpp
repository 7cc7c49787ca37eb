#include "experiments/runner/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace agricolmap::experiments {

Progress::Progress(const CampaignScope& scope, const std::vector<Job>& jobs, int at_a_time,
                   const RowTable& table)
    : at_a_time_(at_a_time), terminal_(::isatty(STDERR_FILENO) != 0) {
  if (!terminal_) return;
  for (const Row& row : table.rows()) count(row);
  pairs_.left = static_cast<int>(jobs.size());
  for (const Job& job : jobs) {
    for (const Chain& chain : job.chains) {
      for (const AddedError* error : chain.errors) {
        const Row planned = rowFor(scope, chain, error, job.seed);
        if (table.find(planned.key()) == nullptr) ++runs_[planned.method].left;
      }
    }
  }
}

Progress::~Progress() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::count(const Row& row) {
  Work& work = runs_[row.method];
  ++work.done;
  if (std::isfinite(row.wall_s)) work.seconds += row.wall_s;
  if (!std::isfinite(row.make_s)) return;
  ++pairs_.done;
  pairs_.seconds += row.make_s;
}

void Progress::now(const std::string& case_name, int seed) {
  place_ = fmt::format("{} seed {}", case_name, seed);
  print();
  --pairs_.left;
}

void Progress::done(const Row& row) {
  count(row);
  --runs_[row.method].left;
  print();
}

std::string Progress::timeLeft() const {
  double seconds =
      pairs_.done > 0 ? pairs_.left * pairs_.seconds / static_cast<double>(pairs_.done) : 0.0;
  for (const auto& [method, work] : runs_) {
    if (work.left == 0) continue;
    if (work.done == 0) return "time left unknown yet";
    seconds += work.left * work.seconds / work.done / at_a_time_;
  }
  return seconds < 5400.0 ? fmt::format("{:.0f} min left", seconds / 60.0)
                          : fmt::format("{:.1f} h left", seconds / 3600.0);
}

void Progress::print() const {
  if (!terminal_) return;
  int left = 0;
  for (const auto& [method, work] : runs_) left += work.left;
  fmt::print(stderr, "\r\033[K{} runs, {}; now {}", left, timeLeft(), place_);
  std::fflush(stderr);
}

}  // namespace agricolmap::experiments
