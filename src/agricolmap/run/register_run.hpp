// One registration from its files to the folder of its results: what `register` does, and `batch`
// for each strip.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <string>
#include <vector>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "agricolmap/run/initial_guess.hpp"
#include "agricolmap/run/pair_files.hpp"

namespace agricolmap::run {

struct RegisterRun {
  PairFiles files;
  std::string prior;  ///< file with the initial guess; empty: as initialGuess finds one
  std::string path;   ///< file with the robot's path; empty: as the strip's shape tells
  bool keep_rejected = false;
  bool pictures = true;
  std::string preset;
  pipeline::RegistrationOptions options;  ///< in force
  // For the report.
  std::string version;  ///< of what makes it
  std::string command_line;
  int threads = 0;
};

struct RegisterResult {
  pipeline::Registration registration;
  /// Where the strip lies, from above: corners around it, fixed file's coordinates [m]; where there
  /// is no answer, as the guess lays it.
  std::vector<Eigen::Vector2d> outline;
};

/// Registers and fills `output` with all results; `commit` is the caller's. `fixed` gives the fixed
/// cloud, `say` hears warnings as they come; the report has them, too.
RegisterResult registerInto(const RegisterRun& run, const FixedSource& fixed,
                            const io::StagedOutput& output, Monitor& monitor, const Say& say);

/// Names of files that an earlier run may have left beside those of this one.
std::vector<std::string> staleResults();

/// The command line as one line of text, quoted where a shell would need it.
std::string commandText(const std::vector<std::string>& words);

}  // namespace agricolmap::run
