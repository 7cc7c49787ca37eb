// The rows of the comparison: one per data set, setting, seed and method, in a CSV file that only
// ever grows.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "agricolmap/evaluate/metrics.hpp"
#include "row_file.hpp"

namespace agricolmap::compare {

/// Matches of a data association; none: not a number.
struct MatchCounts {
  double matches = std::numeric_limits<double>::quiet_NaN();
  double right = std::numeric_limits<double>::quiet_NaN();     ///< of them, near the truth
  double coherent = std::numeric_limits<double>::quiet_NaN();  ///< of them, kept by the method
};

/// What one run of one method came to. Numbers that do not exist are NaN, and empty in the file.
struct Row {
  std::string dataset;
  std::string kind;  ///< simulated, semi-real or real
  std::string experiment;
  double scale = 0.0;    ///< scale error, relative
  double setting = 0.0;  ///< what the experiment varies
  int seed = 0;
  std::string method;
  /// accepted, not_accepted, failed (no transform), timeout, crashed, or skipped: not run, as the
  /// method was lost at smaller errors already.
  std::string status;
  bool accepted = false;  ///< the method stands by its transform
  bool correct = false;   ///< the transform is within SuccessLimits, whatever the method says
  evaluate::RegistrationErrors errors;
  double wall_s = std::numeric_limits<double>::quiet_NaN();  ///< of the process [s]
  double run_s = std::numeric_limits<double>::quiet_NaN();   ///< without reading the files [s]
  double cpu_s = std::numeric_limits<double>::quiet_NaN();
  double peak_mib = std::numeric_limits<double>::quiet_NaN();
  double idle_mib = std::numeric_limits<double>::quiet_NaN();  ///< before anything was read
  MatchCounts first;                                           ///< of a method that matches points
  MatchCounts last;    ///< of one that matches again from what the first matching gave
  std::string stages;  ///< `name=seconds` parted by semicolons
  std::string note;    ///< why there is no transform

  /// The answer is right and the method stands by it.
  bool success() const { return accepted && correct; }
  std::string key() const;
};

/// Rows from `path` and the line that says where they come from. A last line that was cut off is
/// left out. Throws InputError.
std::vector<Row> readRows(const std::filesystem::path& path, std::string& identity);

/// The file open for appending, locked against a second run in the same folder.
class RowTable {
 public:
  /// Opens or makes the file; throws InputError when its rows have another identity.
  RowTable(const std::filesystem::path& path, std::string_view identity);

  const std::vector<Row>& rows() const { return rows_; }
  /// Nothing when there is no such row yet.
  const Row* find(const std::string& key) const;
  /// Adds a row and hands it to the system at once. Throws OutputError.
  void append(const Row& row);

 private:
  campaign::RowFile file_;
  std::vector<Row> rows_;
  std::map<std::string, std::size_t> places_;
};

}  // namespace agricolmap::compare
