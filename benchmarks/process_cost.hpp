// What programs cost: times and memory, as the system counts them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace agricolmap {

/// A folder that goes with the program.
class WorkFolder {
 public:
  WorkFolder();
  ~WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct ProcessCost {
  double wall_s = 0.0;
  double cpu_s = 0.0;
  double peak_mib = 0.0;
};

/// Runs a program to its end. `accepted_codes`: exit codes that are an answer.
ProcessCost runProgram(const std::vector<std::string>& command,
                       const std::vector<int>& accepted_codes);

/// As lines of a table: program, threads, repeat, quantity, value.
std::string costLines(const std::string& program, int threads, int repeat, const ProcessCost& cost);

}  // namespace agricolmap
