// What is left to run, pair by pair.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/methods/method.hpp"
#include "experiments/pairs/suite.hpp"
#include "experiments/runner/row_table.hpp"

namespace agricolmap::experiments {

/// What a campaign consists of.
struct CampaignScope {
  std::vector<Suite> suites = {};
  std::vector<Method> methods = {};
  std::string source = {};  ///< of the program
};

/// A curve of one method on one pair, worked off guess by guess, so that what comes next can depend
/// on what came before.
struct Chain {
  const Suite* suite;
  const Case* chosen;
  std::vector<const AddedError*> errors;  ///< nullptr: the case's own guess
  bool rising;                            ///< in this order
  const Method* method;
  std::uint64_t options = 0;  ///< hash of case and method
};

/// One pair and the chains that are not complete on it.
struct Job {
  const Case* chosen;
  int seed;
  std::vector<Chain> chains;
  std::size_t runs = 0;  ///< of them, left
};

/// The row of a run before anything came of it.
Row rowFor(const CampaignScope& scope, const Chain& chain, const AddedError* error, int seed);

/// What is told of the guess.
PriorUncertainty toldFor(const Chain& chain, const AddedError* error);

/// All jobs, block of seeds by block of seeds, so that an interrupted campaign has all cases; in a
/// block pairs of one drone's view together, so that it is made once. Throws InputError when the
/// table has a row of one of the runs from other options.
std::vector<Job> planCampaign(const CampaignScope& scope, const RowTable& table);

/// Whether the method, a rigid one, leaves the whole scale error of the guess, and that alone is
/// too much: such a run is not made, and counts as a failure.
bool cannotBeRight(const Traits& traits, const AddedError& error);

/// Whether run number `next` of the chain is past hope: the method failed on all pairs of the case
/// at the three errors before it, and on all pairs of cases of its kind there, six or more.
bool hopeless(const std::vector<Row>& rows, const Chain& chain, std::size_t next);

}  // namespace agricolmap::experiments
