// The rows of a campaign: one per case, seed and preset, in a CSV file that only ever grows.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "agricolmap/evaluate/metrics.hpp"
#include "row_file.hpp"

namespace agricolmap::campaign {

/// What one registration of one pair came to. Numbers that do not exist are NaN, and empty in the
/// file.
struct PairRow {
  std::string case_name;
  int seed = 0;
  int field = 0;  ///< seed of the field: pairs of one field are not independent
  std::string preset;
  std::string status;  ///< of the verdict, in its words
  bool accepted = false;
  bool correct = false;   ///< within SuccessLimits, whatever the verdict
  bool negative = false;  ///< the clouds come from different fields: nothing can be correct
  evaluate::RegistrationErrors errors;
  double uniqueness = std::numeric_limits<double>::quiet_NaN();
  double agreement = std::numeric_limits<double>::quiet_NaN();
  double significance = std::numeric_limits<double>::quiet_NaN();
  double overlap = std::numeric_limits<double>::quiet_NaN();
  double correlation = std::numeric_limits<double>::quiet_NaN();
  double blocks = std::numeric_limits<double>::quiet_NaN();        ///< usable ones
  double block_rms = std::numeric_limits<double>::quiet_NaN();     ///< of the agreeing ones [m]
  double attempts = std::numeric_limits<double>::quiet_NaN();      ///< searches until this answer
  double expected_rms = std::numeric_limits<double>::quiet_NaN();  ///< as the program expects [m]
  double local_rms = std::numeric_limits<double>::quiet_NaN();     ///< that no affine undoes [m]
  double height_deviation = std::numeric_limits<double>::quiet_NaN();  ///< as it states [m]
  double probability = std::numeric_limits<double>::quiet_NaN();       ///< of being right
  /// Squared error of the five horizontal parameters over the covariance that the program states,
  /// and that of the strip's centre alone.
  double mahalanobis2 = std::numeric_limits<double>::quiet_NaN();
  double centre_mahalanobis2 = std::numeric_limits<double>::quiet_NaN();
  double height_mahalanobis2 = std::numeric_limits<double>::quiet_NaN();  ///< of the mean height
  std::size_t fixed_points = 0;
  std::size_t moving_points = 0;
  int threads = 0;
  double simulate_s = 0.0;  ///< making the pair [s]
  double total_s = 0.0;     ///< the registration [s]
  std::string stages;       ///< `name=seconds` parted by semicolons
  std::string note;         ///< why there is no transform

  /// The answer is right and the program says so.
  bool success() const { return accepted && correct; }
};

/// Errors of a registration without a transform: all NaN.
evaluate::RegistrationErrors noErrors();

/// The rows of a campaign's CSV and the line that says where they come from. A last line that was
/// cut off is left out. Throws InputError naming file, line and what is wrong.
std::vector<PairRow> readPairs(const std::filesystem::path& path, std::string& identity);

/// The file open for appending, locked against a second campaign in the same folder.
class PairTable {
 public:
  /// Opens or makes the file. `identity` is one line that says what program and options the rows
  /// come from; throws InputError when the file has another. A last line that was cut off by a
  /// crash is removed.
  PairTable(const std::filesystem::path& path, std::string_view identity);

  const std::vector<PairRow>& rows() const { return rows_; }
  bool has(const std::string& case_name, int seed, const std::string& preset) const {
    return keys_.contains({case_name, seed, preset});
  }
  /// Adds a row and hands it to the system at once. Throws OutputError.
  void append(const PairRow& row);

 private:
  RowFile file_;
  std::vector<PairRow> rows_;
  std::set<std::tuple<std::string, int, std::string>> keys_;
};

}  // namespace agricolmap::campaign
