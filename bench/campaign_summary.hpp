// From the rows of a campaign to figures with intervals and the targets beside them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "campaign_table.hpp"

namespace agricolmap::campaign {

/// What a case should reach. Limits on shares are in 0…1, on errors in metres.
struct Target {
  std::optional<double> min_success = {};
  std::optional<double> max_accepted = {};  ///< for pairs of different fields
  std::optional<double> max_rms = {};       ///< horizontal RMS to the best affine, of successes
  bool worst_rms = false;                   ///< max_rms is for the worst success, else the median
  std::optional<double> max_rms3d = {};     ///< median RMS over the points, of successes
  std::optional<double> max_time = {};      ///< median [s]
  std::optional<double> min_found = {};     ///< accepted and right in the plane
  std::optional<double> max_false = {};     ///< accepted and wrong
  std::optional<double> max_refused = {};   ///< not accepted, whatever the answer
};

/// The target in words, a dash for none.
std::string targetText(const Target& target);

struct Interval {
  double low = 0.0;
  double high = 1.0;
};

/// Wilson's 95 % interval of a share (Wilson 1927): good for few trials and shares near 0 and 1.
Interval wilsonInterval(std::size_t hits, std::size_t trials);

/// The value below which a share of the sorted or unsorted values lies, interpolated linearly; NaN
/// for none.
double quantile(std::vector<double> values, double share);

struct SummaryLine {
  std::string case_name;
  std::string preset;
  bool negative = false;
  std::size_t pairs = 0;
  std::size_t successes = 0;
  std::size_t accepted = 0;
  std::size_t found = 0;          ///< accepted and within 5 cm horizontally
  std::size_t false_accepts = 0;  ///< accepted, yet outside the limits
  Interval success_interval;
  Interval accepted_interval;
  // Over the successes [m]; NaN when there are none.
  double rms_median = 0.0;  ///< horizontal, to the best affine
  double rms_p95 = 0.0;
  double rms_worst = 0.0;
  double rms3d_median = 0.0;  ///< over the points, drift included
  double rms3d_p95 = 0.0;
  // Over all pairs [s].
  double time_median = 0.0;
  double time_p95 = 0.0;
  Target target;
  /// Nothing when the case has no target.
  std::optional<bool> met() const;
};

/// One line per case and preset that has rows: cases in the order of `cases`, unknown ones last.
std::vector<SummaryLine> summarise(const std::vector<PairRow>& rows,
                                   const std::vector<std::string>& cases,
                                   const std::map<std::string, Target>& targets);

std::string summaryCsv(const std::vector<SummaryLine>& lines);
/// A document with one table; `identity` is the rows' origin in one line.
std::string summaryMarkdown(const std::vector<SummaryLine>& lines, const std::string& identity);

}  // namespace agricolmap::campaign
