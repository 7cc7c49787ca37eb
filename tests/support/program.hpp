// Running the program as a user does: arguments, exit code, what it says.
#pragma once

#include <string>
#include <vector>

namespace agricolmap::test {

struct ProgramResult {
  int exit_code = -1;  ///< 128 + signal when a signal killed it
  std::string out;
  std::string err;
};

/// Runs agricolmap with standard input empty. With `interrupt_at` it gets SIGINT as soon as its
/// stderr contains that text.
ProgramResult runAgricolmap(const std::vector<std::string>& arguments,
                            const std::string& interrupt_at = "");

/// Runs `before` agricolmap `arguments` `after` in a shell, as "ulimit -f 8;" and "> /dev/full".
ProgramResult runInShell(const std::string& before, const std::vector<std::string>& arguments,
                         const std::string& after = "");

}  // namespace agricolmap::test
