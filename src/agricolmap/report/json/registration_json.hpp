// registration.json: everything a program or a reader may want to know about a registration.
// The schema is documented in docs/registration-json.md.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/monitor.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/pipeline/registration.hpp"

namespace agricolmap::report {

/// What neither the clouds nor the registration know.
struct RegistrationReportInfo {
  std::string version;
  std::uint64_t seed = 0;
  int threads = 0;  ///< as asked for; 0 is reported as the number in force
  std::string command_line;
  std::string preset;
  /// Moving file coordinates → fixed file coordinates, as the registration started [m].
  Eigen::Affine3d prior = Eigen::Affine3d::Identity();
  std::string prior_source;           ///< in words, e.g. the files it came from
  nlohmann::ordered_json options;     ///< all options in force
  std::vector<std::string> pictures;  ///< names of the pictures beside the report
  /// What the coordinates of the files themselves are in; nothing where nobody said.
  std::optional<Crs> fixed_file_crs;
  std::optional<Crs> moving_file_crs;
};

/// What was said about the clouds when they were read, and on the way.
std::vector<std::string> warningsOf(const PointStream& fixed, const Cloud& moving,
                                    const Monitor& monitor);

/// The report; numbers are doubles to the last digit, what is not finite is null. All strings are
/// valid UTF-8.
nlohmann::ordered_json registrationJson(const PointStream& fixed, const Cloud& moving,
                                        const pipeline::Registration& registration,
                                        const Monitor& monitor, const RegistrationReportInfo& info);

/// Writes it, indented. Throws OutputError.
void writeRegistrationJson(const io::OutputPath& path, const PointStream& fixed,
                           const Cloud& moving, const pipeline::Registration& registration,
                           const Monitor& monitor, const RegistrationReportInfo& info);

/// Most memory that the process ever held [bytes]; 0 where the system does not tell.
std::size_t peakMemoryBytes();

}  // namespace agricolmap::report
