// How far the comparison is, on stderr.
#pragma once

#include <map>
#include <string>

#include "agricolmap/core/stopwatch.hpp"
#include "runner/campaign.hpp"

namespace agricolmap::experiments {

/// In place on a terminal, else a line every half minute. Not for several threads at once.
class Progress {
 public:
  Progress(const CampaignOptions& options, const RowTable& table);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is being worked on.
  void now(const std::string& dataset, int seed);
  void done(const Row& row);

 private:
  void add(const Row& row);
  void print();
  /// From each method's mean time over all rows so far, those of earlier runs included.
  std::string timeLeft() const;

  struct Sum {
    double seconds = 0.0;
    int runs = 0;
  };
  std::map<std::string, Sum> sums_;  ///< per method
  std::map<std::string, int> left_;  ///< runs per method
  int jobs_;
  std::string place_;
  Stopwatch watch_;
  double last_ = -1e9;
  bool terminal_;
};

}  // namespace agricolmap::experiments
