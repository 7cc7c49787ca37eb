// One method on one pair from one guess: its errors against the truth and what it cost.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "experiments/methods/method.hpp"
#include "experiments/pairs/guess.hpp"
#include "experiments/pairs/pair_maker.hpp"
#include "experiments/runner/row.hpp"

namespace agricolmap::experiments {

/// What a method is run from.
struct Start {
  std::string suite;
  const AddedError* error = nullptr;  ///< nullptr: the pair's guess as it is
  PriorUncertainty told;
};

/// Runs methods on a pair, one at a time: times are those of the whole process.
class PairRuns {
 public:
  PairRuns(Pair pair, int seed);
  /// Fills what came of it and what it cost.
  void run(const Method& method, const Start& start, Row& row);

 private:
  /// A moving cloud and where it truly belongs.
  struct Moving {
    Cloud cloud;
    evaluate::Truth truth;
  };
  /// The moving cloud with the error's scale.
  const Moving& movingFor(const AddedError* error);
  Eigen::Affine3d guessFor(const Start& start) const;
  void fillDeformation(const MethodOutcome& outcome, const Moving& moving, Row& row) const;
  void fillErrors(const MethodOutcome& outcome, const Moving& moving, Row& row) const;

  std::shared_ptr<const Cloud> fixed_;
  Eigen::Affine3d guess_;
  bool overlaps_;
  int seed_;
  std::vector<Eigen::Vector3d> slips_;
  Moving unscaled_;
  std::map<double, Moving> scaled_;  ///< by the scale error
};

}  // namespace agricolmap::experiments
