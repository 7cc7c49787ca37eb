// How a program ends.
#pragma once

#include "agricolmap/core/error.hpp"

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
  kSomeFailed = 12,  ///< of many registrations some ended without an answer
  kInterrupted = 130,
};

inline ExitCode exitCodeOf(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kUsage:
      return ExitCode::kUsage;
    case ErrorKind::kInput:
      return ExitCode::kBadInput;
    case ErrorKind::kOutput:
      return ExitCode::kOutput;
    case ErrorKind::kInterrupted:
      return ExitCode::kInterrupted;
    case ErrorKind::kInternal:
      break;
  }
  return ExitCode::kInternal;
}

}  // namespace agricolmap
