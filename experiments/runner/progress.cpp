#include "runner/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace agricolmap::experiments {

Progress::Progress(const CampaignOptions& options, const RowTable& table)
    : jobs_(options.jobs), terminal_(::isatty(STDERR_FILENO) != 0) {
  for (const Row& row : table.rows()) add(row);
  for (const DataSet& data : options.datasets) {
    for (const Curve& curve : options.curves) {
      for (const Cell& cell : curve.cells) {
        for (const std::string& method : options.methods) {
          if (!takesPart(method, cell.experiment)) continue;
          for (int i = 0; i < options.pairs; ++i) {
            Row row;
            row.dataset = data.name;
            row.experiment = cell.experiment;
            row.scale = cell.scale;
            row.setting = cell.setting;
            row.seed = options.first_seed + i;
            row.method = method;
            if (table.find(row.key()) == nullptr) ++left_[method];
          }
        }
      }
    }
  }
}

Progress::~Progress() {
  if (terminal_) fmt::print(stderr, "\r\033[K");
}

void Progress::add(const Row& row) {
  Sum& sum = sums_[row.method];
  ++sum.runs;
  if (std::isfinite(row.wall_s)) sum.seconds += row.wall_s;
}

void Progress::now(const std::string& dataset, int seed) {
  place_ = fmt::format("{} seed {}", dataset, seed);
  print();
}

void Progress::done(const Row& row) {
  add(row);
  --left_[row.method];
  print();
}

std::string Progress::timeLeft() const {
  double seconds = 0.0;
  for (const auto& [method, runs] : left_) {
    if (runs == 0) continue;
    const auto sum = sums_.find(method);
    if (sum == sums_.end()) return "time left unknown yet";
    seconds += runs * sum->second.seconds / sum->second.runs / jobs_;
  }
  return seconds < 5400.0 ? fmt::format("{:.0f} min left", seconds / 60.0)
                          : fmt::format("{:.1f} h left", seconds / 3600.0);
}

void Progress::print() {
  const double now = watch_.seconds();
  if (!terminal_ && now - last_ < 30.0) return;
  last_ = now;
  int runs = 0;
  for (const auto& [method, count] : left_) runs += count;
  fmt::print(stderr, "{}{} runs, {}; now {}{}", terminal_ ? "\r\033[K" : "", runs, timeLeft(),
             place_, terminal_ ? "" : "\n");
  std::fflush(stderr);
}

}  // namespace agricolmap::experiments
