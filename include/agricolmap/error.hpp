// What can go wrong, as types. A registration that fails is not here: it is a status of the result.
#pragma once

#include <stdexcept>
#include <string>

#include "agricolmap/export.hpp"

namespace agricolmap {

/// What kind of error. A program maps it to its exit codes.
enum class ErrorKind {
  kInternal,     ///< what no caller can mend: a processor or a system that cannot
  kUsage,        ///< see UsageError
  kInput,        ///< see InputError
  kOutput,       ///< see OutputError
  kInterrupted,  ///< see Interrupted
};

/// What would mend it, for callers with words of their own for that: a program's flags.
enum class Remedy {
  kNone,  ///< none but what the message says
  kHeightsAlone,
  kInitialGuess,
  kNarrowerGuess,
  kOverwrite,
  kPixelSize,
  kSurfaceModel,
  kRowHeading,
  kWindow,
  kResumeOrOverwrite,
};

/// Base of all errors thrown on purpose. `what()` names the place and the remedy.
class AGRICOLMAP_EXPORT Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message, Remedy remedy = Remedy::kNone)
      : std::runtime_error(message), kind_(kind), remedy_(remedy) {}
  ErrorKind kind() const { return kind_; }
  Remedy remedy() const { return remedy_; }

 private:
  ErrorKind kind_;
  Remedy remedy_;
};

/// Options or arguments that make no sense.
class AGRICOLMAP_EXPORT UsageError : public Error {
 public:
  explicit UsageError(const std::string& message, Remedy remedy = Remedy::kNone)
      : Error(ErrorKind::kUsage, message, remedy) {}
};

/// A file or cloud that cannot be used: missing, truncated, lying, empty, degenerate.
class AGRICOLMAP_EXPORT InputError : public Error {
 public:
  explicit InputError(const std::string& message, Remedy remedy = Remedy::kNone)
      : Error(ErrorKind::kInput, message, remedy) {}
};

/// A result that cannot be written: no permission, disk full, exists already.
class AGRICOLMAP_EXPORT OutputError : public Error {
 public:
  explicit OutputError(const std::string& message, Remedy remedy = Remedy::kNone)
      : Error(ErrorKind::kOutput, message, remedy) {}
};

/// The caller asked to stop.
class AGRICOLMAP_EXPORT Interrupted : public Error {
 public:
  Interrupted() : Error(ErrorKind::kInterrupted, "interrupted; nothing was written") {}
};

}  // namespace agricolmap
