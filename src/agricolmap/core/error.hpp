// What can go wrong, as types. A registration that fails is not here: it is a status of the result.
#pragma once

#include <stdexcept>
#include <string>

namespace agricolmap {

/// Exit codes of the command line, one per kind of outcome. 10 and above: the program worked and
/// its answer is not "accepted".
enum class ExitCode : int {
  kOk = 0,
  kInternal = 1,
  kUsage = 2,
  kBadInput = 3,
  kOutput = 4,
  kRejected = 10,
  kAmbiguous = 11,
  kInterrupted = 130,
};

/// Base of all errors thrown on purpose. `what()` names the place and the remedy.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// Options or arguments that make no sense.
class UsageError : public Error {
 public:
  explicit UsageError(const std::string& message) : Error(ExitCode::kUsage, message) {}
};

/// A file or cloud that cannot be used: missing, truncated, lying, empty, degenerate.
class InputError : public Error {
 public:
  explicit InputError(const std::string& message) : Error(ExitCode::kBadInput, message) {}
};

/// A result that cannot be written: no permission, disk full, exists already.
class OutputError : public Error {
 public:
  explicit OutputError(const std::string& message) : Error(ExitCode::kOutput, message) {}
};

/// The user asked to stop (SIGINT, SIGTERM).
class Interrupted : public Error {
 public:
  Interrupted() : Error(ExitCode::kInterrupted, "interrupted; nothing was written") {}
};

}  // namespace agricolmap
