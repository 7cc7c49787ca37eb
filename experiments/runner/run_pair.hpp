// One method on one pair from one guess: in process or as a child, errors against the truth.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "experiments/methods/method.hpp"
#include "experiments/pairs/guess.hpp"
#include "experiments/pairs/pair_maker.hpp"
#include "experiments/runner/outcome_file.hpp"
#include "experiments/runner/row.hpp"

namespace agricolmap::experiments {

/// How methods are run.
struct RunOptions {
  bool in_process = true;
  int threads = 0;                ///< of a child
  double time_limit = 60.0;       ///< a child is killed after so much computing [s]
  std::filesystem::path program;  ///< that has the verb `register-one`
};

/// What a method is run from.
struct Start {
  std::string suite;
  const AddedError* error = nullptr;  ///< nullptr: the pair's guess as it is
  PriorUncertainty told;
};

/// Runs methods on a pair. Children read its clouds from files that are written when first needed.
class PairRuns {
 public:
  /// `folder` exists and is this object's own.
  PairRuns(Pair pair, int seed, RunOptions options, std::filesystem::path folder);

  /// Fills what came of it and what it cost. `name`: of the run's own files. Any thread, but in
  /// process one at a time. Throws InputError when a child ends with an error of usage or input.
  void run(const Method& method, const Start& start, const std::string& name, Row& row);

 private:
  /// A moving cloud and where it truly belongs.
  struct Moving {
    Cloud cloud;
    evaluate::Truth truth;
    std::filesystem::path cloud_file;  ///< of children
    std::filesystem::path truth_file;
  };
  /// The moving cloud with the error's scale.
  const Moving& movingFor(const AddedError* error);
  void writeFiles(const std::string& key, Moving& moving) const;
  Eigen::Affine3d guessFor(const Start& start) const;
  MethodOutcome runHere(const Method& method, const Moving& moving, const Start& start,
                        Row& row) const;
  /// Nothing when it timed out or crashed, which the row then says.
  std::optional<MethodOutcome> runChildOf(const Method& method, const Moving& moving,
                                          const Start& start, const std::string& name,
                                          Row& row) const;
  void fillErrors(const MethodOutcome& outcome, const Moving& moving, Row& row) const;

  std::shared_ptr<const Cloud> fixed_;
  Eigen::Affine3d guess_;
  bool overlaps_;
  int seed_;
  RunOptions options_;
  std::filesystem::path folder_;
  std::mutex mutex_;
  std::map<std::string, Moving> moving_;  ///< by scale; entries stay where they are
  const Moving* unscaled_;
};

/// Most memory that this program has held so far [MiB]. Not getrusage's figure: that starts from
/// what the process held that started this one.
double peakMemory();

}  // namespace agricolmap::experiments
