// A program run as a child, with a time limit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace agricolmap::experiments {

struct ChildResult {
  bool timed_out = false;
  int exit_code = -1;       ///< -1: ended by a signal
  int signal = 0;           ///< that ended it
  double wall_s = 0.0;      ///< from start to end [s]
  double cpu_s = 0.0;       ///< of all its threads, system included [s]
  double peak_mib = 0.0;    ///< most memory seen just before it was killed; 0 if it ended itself
  double rusage_mib = 0.0;  ///< wait4's: not below what the parent held when it started the child
};

/// Runs `command` (its first word a path), output and errors into `log`, and kills it after
/// `seconds` of computing, whatever else the machine has to do meanwhile (or five times as many by
/// the clock). Ctrl-C on the terminal reaches the caller only: the child is killed then and
/// Interrupted thrown. Throws OutputError if it cannot be started.
ChildResult runChild(const std::vector<std::string>& command, double seconds,
                     const std::filesystem::path& log);

}  // namespace agricolmap::experiments
