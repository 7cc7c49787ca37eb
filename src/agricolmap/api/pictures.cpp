#include "agricolmap/report/pictures/pictures.hpp"

#include "agricolmap/api/record.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/report.hpp"

namespace agricolmap {

std::vector<std::string> writePictures(const std::filesystem::path& folder,
                                       const Registration& registration) {
  if (!registration.record) {
    throw UsageError("pictures can only be drawn of what registerClouds returned");
  }
  const Registration::Record& record = *registration.record;
  return report::writePictures(folder, record.found,
                               {record.fixed_name, record.moving_name, record.evidence});
}

}  // namespace agricolmap
