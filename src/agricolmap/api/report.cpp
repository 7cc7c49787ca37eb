#include "agricolmap/report.hpp"

#include "agricolmap/api/record.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"

namespace agricolmap {

std::string reportText(const Registration& registration, const std::vector<std::string>& pictures) {
  if (!registration.record) {
    throw UsageError("a report can only be written of what registerClouds returned");
  }
  nlohmann::ordered_json report = registration.record->report;
  report["pictures"] = pictures;
  return report.dump(2) + "\n";
}

void writeReport(const std::filesystem::path& folder, const Registration& registration,
                 const std::vector<std::string>& pictures) {
  io::writeText(folder / "registration.json", reportText(registration, pictures));
}

}  // namespace agricolmap
