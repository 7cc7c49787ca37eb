#include "process_cost.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/stopwatch.hpp"

namespace agricolmap {
namespace {

namespace fs = std::filesystem;

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

WorkFolder::WorkFolder() {
  std::string name = (fs::temp_directory_path() / "agricolmap_time_XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw OutputError(fmt::format("{}: cannot be made; set TMPDIR", name));
  }
  path_ = name;
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

ProcessCost runProgram(const std::vector<std::string>& command,
                       const std::vector<int>& accepted_codes) {
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  pid_t pid = 0;
  const Stopwatch watch;
  if (const int error = ::posix_spawnp(&pid, argv[0], nullptr, nullptr, argv.data(), environ)) {
    throw UsageError(fmt::format("{}: cannot be run: {}", command[0], std::strerror(error)));
  }
  int status = 0;
  rusage usage{};
  while (::wait4(pid, &status, 0, &usage) < 0) {
    if (errno != EINTR) throw Error(ErrorKind::kInternal, "wait4 failed");
  }
  const ProcessCost cost = {watch.seconds(), secondsOf(usage.ru_utime) + secondsOf(usage.ru_stime),
                            static_cast<double>(usage.ru_maxrss) / 1024.0};
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  if (std::find(accepted_codes.begin(), accepted_codes.end(), code) == accepted_codes.end()) {
    throw Error(ErrorKind::kInternal,
                fmt::format("'{}' ended with code {}", fmt::join(command, " "), code));
  }
  return cost;
}

std::string costLines(const std::string& program, int threads, int repeat,
                      const ProcessCost& cost) {
  const std::string head = fmt::format("{},{},{}", program, threads, repeat);
  return fmt::format("{0},wall_s,{1:.4f}\n{0},cpu_s,{2:.4f}\n{0},peak_mib,{3:.1f}\n", head,
                     cost.wall_s, cost.cpu_s, cost.peak_mib);
}

}  // namespace agricolmap
