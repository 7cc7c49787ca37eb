// Shares, errors and times of groups of rows.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "campaign_summary.hpp"
#include "runner/rows.hpp"

namespace agricolmap::compare {

using RowTest = std::function<bool(const Row&)>;

/// Rows of one method in one cell. Skipped runs count as failures.
struct Group {
  std::size_t runs = 0;
  std::size_t successes = 0;  ///< right, and the method stands by it
  std::size_t right = 0;      ///< whatever the method says
  std::size_t wrong = 0;      ///< the method stands by a wrong answer
  std::size_t skipped = 0;
  std::size_t timeouts = 0;
  // Over the successes; NaN without any.
  double e_t = 0.0;         ///< mean [m]
  double e_r = 0.0;         ///< mean [rad]
  double e_s = 0.0;         ///< mean
  double rms = 0.0;         ///< median of the RMS over the points [m]
  double rms_affine = 0.0;  ///< median of the horizontal RMS to the best affine [m]
  double share() const;
  campaign::Interval interval() const;
};

Group groupOf(const std::vector<Row>& rows, const RowTest& test);

/// Rows in which Go-ICP stands by the answer that it held when its time was up. By the rule of its
/// paper it has none before the bound is proven, which the limit hardly ever leaves it the time
/// for; whoever uses it would take what it has.
std::vector<Row> withHeldAnswers(std::vector<Row> rows);

/// What makes two rows of one setting comparable: the same pair of clouds, by data set and seed.
using PairKey = std::pair<std::string, int>;
PairKey pairOf(const Row& row);
std::set<PairKey> pairsOf(const std::vector<Row>& rows, const RowTest& test);

/// Values of one column of the rows in order, each once.
std::vector<std::string> distinct(const std::vector<Row>& rows,
                                  const std::function<std::string(const Row&)>& column);
std::vector<double> distinctNumbers(const std::vector<Row>& rows, double Row::*column,
                                    const RowTest& test);
/// Data sets, kinds and methods that rows have, in the order in which they are listed everywhere.
std::vector<std::string> dataSetsOf(const std::vector<Row>& rows);
std::vector<std::string> kindsOf(const std::vector<Row>& rows);
std::vector<std::string> methodsOf(const std::vector<Row>& rows);

/// 0…1 with two digits, or as short as it goes when it is 0 or 1.
std::string shareText(double share);
/// A dash for what is not finite.
std::string numberText(double value, int digits);

/// CSV of the success rates of `experiment` per kind, data set (and all of a kind) and setting.
std::string successCsv(const std::vector<Row>& rows, const std::string& experiment);
std::string accuracyCsv(const std::vector<Row>& rows);
std::string inliersCsv(const std::vector<Row>& rows);
std::string timesCsv(const std::vector<Row>& rows);

/// Computing times of one method over the runs that ended by themselves [s], memory [MiB].
struct TimeLine {
  std::string method;
  std::size_t runs = 0;      ///< that were started
  std::size_t timeouts = 0;  ///< and ended at the limit
  std::size_t successes = 0;
  double min = 0.0, max = 0.0, mean = 0.0;             ///< over the successes
  double mean_all = 0.0;                               ///< over all that ended by themselves
  double peak_mib = 0.0;                               ///< median of all
  std::vector<std::pair<std::string, double>> stages;  ///< share of the time of successes
};
std::vector<TimeLine> timeLines(const std::vector<Row>& rows);

/// Matches in percent of all: mean and deviation over runs.
struct MatchShares {
  std::size_t runs = 0;
  double matches = 0.0;                             ///< mean number
  double right = 0.0, right_deviation = 0.0;        ///< near the truth
  double coherent = 0.0, coherent_deviation = 0.0;  ///< kept by the method
};

/// Matches of one method on one data set.
struct InlierLine {
  std::string dataset;
  std::string kind;
  std::string method;
  MatchShares first;
  MatchShares last;  ///< no runs: it does not match again
};
std::vector<InlierLine> inlierLines(const std::vector<Row>& rows);

}  // namespace agricolmap::compare
