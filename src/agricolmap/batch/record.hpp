// What is told of a strip that is done: batch_item.json in its folder, and a line of the summary.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/batch/manifest.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/verdict/verdict.hpp"

namespace agricolmap::batch {

inline constexpr const char* kRecordName = "batch_item.json";

struct Record {
  std::string id;
  std::string map;
  int date = 0;              ///< YYYYMMDD, 0: nobody said
  std::string fingerprint;   ///< of what the answer depends on
  std::string status;        ///< "accepted", "rejected", "ambiguous"; "failed": there is no answer
  double probability = 0.0;  ///< that it is right in the plane to 5 cm
  double expected_error = std::numeric_limits<double>::quiet_NaN();  ///< RMS in the plane [m]
  std::string heights;                                               ///< "measured" or "limited"
  double height_error = std::numeric_limits<double>::quiet_NaN();    ///< deviation [m]
  double seconds = 0.0;
  std::string message;  ///< why, in a line
  /// Corners around the strip from above, fixed file's coordinates [m].
  std::vector<Eigen::Vector2d> outline;

  bool failed() const { return status == "failed"; }
};

/// One of a strip, with no answer yet.
Record recordOf(const Strip& strip, const Manifest& manifest);
/// Takes over what was found.
void setVerdict(const verdict::Verdict& verdict,
                const std::optional<verdict::PoseUncertainty>& uncertainty, Record& record);

nlohmann::ordered_json toJson(const Record& record);
/// Throws OutputError.
void writeRecord(const io::OutputPath& path, const Record& record);
/// The record in the folder of a strip; nothing where there is none that can be read.
std::optional<Record> readRecord(const std::filesystem::path& folder);

/// Of all that the answer of a strip depends on: names, sizes and times of change of the files,
/// those beside them that are looked at, too, and all options in force. Not of this program's
/// version. 16 hexadecimal digits.
std::string fingerprintOf(const Strip& strip, const Manifest& manifest);

}  // namespace agricolmap::batch
