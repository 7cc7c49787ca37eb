// registration.json: everything a program or a reader may want to know about a registration.
// The schema is documented in docs/registration-json.md.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap {

/// One cloud as it was read.
struct CloudReport {
  std::string path;
  std::size_t points = 0;
  std::size_t dropped_points = 0;  ///< NaN/Inf, left out
  bool has_colour = false;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();   ///< file coordinates of the local zero [m]
  Eigen::Vector3d box_min = Eigen::Vector3d::Zero();  ///< file coordinates [m]
  Eigen::Vector3d box_max = Eigen::Vector3d::Zero();
};
CloudReport cloudReport(const Cloud& cloud, std::string path);

/// What the registration itself does not know.
struct RegistrationReportInfo {
  std::string version;
  std::uint64_t seed = 0;
  std::vector<std::string> command_line;
  CloudReport fixed;
  CloudReport moving;
  /// Moving file coordinates → fixed file coordinates, as the registration started [m].
  Eigen::Affine3d guess = Eigen::Affine3d::Identity();
  std::string guess_source;        ///< in words, e.g. the files it came from
  nlohmann::ordered_json options;  ///< all options in force
  std::vector<std::pair<std::string, double>> stage_times;  ///< StageTimes::stages() [s]
  double total_time = 0.0;                                  ///< wall clock [s]
  std::size_t peak_memory = 0;                              ///< [bytes]
  int threads = 0;
  std::vector<std::string> pictures;  ///< names of files written beside the report
};

/// The report; numbers are doubles to the last digit, what is not finite is null. All strings are
/// valid UTF-8.
nlohmann::ordered_json registrationJson(const Registration& registration,
                                        const RegistrationReportInfo& info);

/// Most memory that the process ever held [bytes]; 0 where the system does not tell.
std::size_t peakMemoryBytes();

}  // namespace agricolmap
