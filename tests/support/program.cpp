#include "support/program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace agricolmap::test {
namespace {

struct Pipe {
  int read_end = -1;
  int write_end = -1;
  Pipe() {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    read_end = ends[0];
    write_end = ends[1];
  }
  ~Pipe() {
    ::close(read_end);
    closeWriteEnd();
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void closeWriteEnd() {
    if (write_end >= 0) ::close(std::exchange(write_end, -1));
  }
};

std::string programPath() {
  const char* const chosen = std::getenv("AGRICOLMAP_PROGRAM");
  return chosen != nullptr ? chosen : AGRICOLMAP_PROGRAM;
}

[[noreturn]] void becomeProgram(std::vector<char*>& argv, const Pipe& out, const Pipe& err) {
  const int nothing = ::open("/dev/null", O_RDONLY);
  if (nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0) ::_exit(127);
  ::dup2(out.write_end, STDOUT_FILENO);
  ::dup2(err.write_end, STDERR_FILENO);
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

/// Appends what there is to read; false at the end.
bool readSome(int fd, std::string& text) {
  std::array<char, 4096> buffer{};
  const ssize_t count = ::read(fd, buffer.data(), buffer.size());
  if (count < 0) return errno == EINTR;
  text.append(buffer.data(), static_cast<std::size_t>(count));
  return count > 0;
}

}  // namespace

namespace {

ProgramResult runWords(std::vector<std::string> words, const std::string& interrupt_at) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  Pipe out;
  Pipe err;
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("no process");
  if (child == 0) becomeProgram(argv, out, err);
  out.closeWriteEnd();
  err.closeWriteEnd();

  ProgramResult result;
  bool waiting = !interrupt_at.empty();
  std::array<pollfd, 2> ends{{{out.read_end, POLLIN, 0}, {err.read_end, POLLIN, 0}}};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    if (::poll(ends.data(), ends.size(), -1) < 0 && errno != EINTR) break;
    if (ends[0].revents != 0 && !readSome(ends[0].fd, result.out)) ends[0].fd = -1;
    if (ends[1].revents != 0 && !readSome(ends[1].fd, result.err)) ends[1].fd = -1;
    if (waiting && result.err.find(interrupt_at) != std::string::npos) {
      ::kill(child, SIGINT);
      waiting = false;
    }
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace

ProgramResult runAgricolmap(const std::vector<std::string>& arguments,
                            const std::string& interrupt_at) {
  std::vector<std::string> words = {programPath()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return runWords(std::move(words), interrupt_at);
}

ProgramResult runInShell(const std::string& before, const std::vector<std::string>& arguments,
                         const std::string& after) {
  std::string line = before + " '" + programPath() + "'";
  for (const std::string& argument : arguments) line += " '" + argument + "'";
  return runWords({"/bin/sh", "-c", line + " " + after}, "");
}

}  // namespace agricolmap::test
