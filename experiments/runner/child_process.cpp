#include "experiments/runner/child_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/stopwatch.hpp"

namespace agricolmap::experiments {
namespace {

/// A child that computes nothing, or on a machine with much else to do, may take this many times
/// its limit.
constexpr double kMostWaiting = 5.0;

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// High-water mark of a running process [MiB]; 0 if it cannot be read.
double highWater(pid_t child) {
  std::ifstream status(fmt::format("/proc/{}/status", child));
  for (std::string word; status >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  return 0.0;
}

/// What a running process has computed so far, all its threads [s]; 0 if it cannot be read.
double cpuSeconds(pid_t child) {
  std::ifstream file(fmt::format("/proc/{}/stat", child));
  std::string line;
  std::getline(file, line);
  // The program's name stands in parentheses and may contain anything; 11 fields follow, then two
  // numbers of clock ticks.
  std::istringstream rest(line.substr(std::min(line.size(), line.rfind(')') + 1)));
  std::string skipped;
  for (int i = 0; i < 11; ++i) rest >> skipped;
  double user = 0.0, system = 0.0;
  rest >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

pid_t start(const std::vector<std::string>& command, const std::filesystem::path& log) {
  std::vector<std::string> copy = command;
  std::vector<char*> words;
  words.reserve(copy.size() + 1);
  for (std::string& word : copy) words.push_back(word.data());
  words.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0644);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  // A group of its own: the terminal's Ctrl-C is for the caller.
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  posix_spawnattr_setpgroup(&attributes, 0);
  pid_t child = 0;
  const int error = posix_spawn(&child, words[0], &actions, &attributes, words.data(), ::environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  if (error != 0) {
    throw OutputError(fmt::format("{}: cannot be started: {}", command[0], std::strerror(error)));
  }
  return child;
}

}  // namespace

ChildResult runChild(const std::vector<std::string>& command, double limit_s,
                     const std::filesystem::path& log) {
  using namespace std::chrono_literals;
  throwIfInterrupted();
  const Stopwatch watch;
  const pid_t child = start(command, log);
  ChildResult result;
  rusage usage{};
  int status = 0;
  bool killed = false;
  while (true) {
    const pid_t ended = ::wait4(child, &status, killed ? 0 : WNOHANG, &usage);
    if (ended == child) break;
    if (ended < 0 && errno != EINTR) {
      throw OutputError(
          fmt::format("{}: cannot be waited for: {}", command[0], std::strerror(errno)));
    }
    result.timed_out = cpuSeconds(child) > limit_s || watch.seconds() > kMostWaiting * limit_s;
    if (!killed && (result.timed_out || interruptRequested())) {
      result.peak_mib = highWater(child);
      ::kill(-child, SIGKILL);
      killed = true;
    }
    if (!killed) std::this_thread::sleep_for(5ms);
  }
  throwIfInterrupted();
  result.timed_out = result.timed_out && killed;
  result.wall_s = watch.seconds();
  result.cpu_s = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  result.rusage_mib = static_cast<double>(usage.ru_maxrss) / 1024.0;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  return result;
}

}  // namespace agricolmap::experiments
