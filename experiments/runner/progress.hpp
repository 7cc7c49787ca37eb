// How far a campaign is, on a terminal's stderr.
#pragma once

#include <string>

#include "agricolmap/core/stopwatch.hpp"

namespace agricolmap::experiments {

/// One line, in place; nothing where stderr is no terminal. Not for several threads at once.
class Progress {
 public:
  explicit Progress(std::size_t runs);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// What is being worked on.
  void now(std::string place);
  /// One more run.
  void done();

 private:
  void print() const;

  std::size_t runs_;
  std::size_t done_ = 0;
  std::string place_;
  Stopwatch watch_;
  bool terminal_;
};

}  // namespace agricolmap::experiments
