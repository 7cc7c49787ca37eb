#include "agricolmap/report/pictures/pictures.hpp"

#include <fmt/format.h>

#include "agricolmap/api/record.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/point_stream.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/report.hpp"
#include "agricolmap/report/page/registration_page.hpp"

namespace agricolmap {
namespace {

const Registration::Record& recordOf(const Registration& registration) {
  if (!registration.record) {
    throw UsageError("pictures can only be drawn of what registerClouds returned");
  }
  return *registration.record;
}

/// Points of another cloud would lie anywhere.
void requireTheSame(const char* which, const std::string& name, const Cloud& cloud,
                    std::size_t points, const Eigen::Vector3d& origin) {
  if (cloud.size() == points && cloud.origin == origin) return;
  throw UsageError(
      fmt::format("{}: is not the {} cloud that was registered, which was {} with {} points",
                  cloud.name, which, name, points));
}

void writePageOf(const std::filesystem::path& folder, const Registration::Record& record,
                 const std::vector<std::string>& pictures, nlohmann::ordered_json scene,
                 const std::string& scene_missing) {
  report::PageContent page;
  page.scene = std::move(scene);
  page.facts = report::pageFacts({record.fixed_origin, record.moving_origin}, record.found,
                                 record.options, record.preset, scene_missing);
  page.report = record.report;
  page.report["pictures"] = pictures;
  report::writeRegistrationPage(folder / report::kPageName, page);
}

}  // namespace

std::vector<std::string> writePictures(const std::filesystem::path& folder,
                                       const Registration& registration) {
  const Registration::Record& record = recordOf(registration);
  return report::writePictures(folder, record.found,
                               {record.fixed_name, record.moving_name, record.options.evidence});
}

void writePage(const std::filesystem::path& folder, const Registration& registration,
               const std::vector<std::string>& pictures) {
  writePageOf(folder, recordOf(registration), pictures, nullptr,
              "the report was written without pictures");
}

void writePage(const std::filesystem::path& folder, const Registration& registration,
               const std::vector<std::string>& pictures, const Cloud& fixed, const Cloud& moving) {
  requireProcessor();
  const Registration::Record& record = recordOf(registration);
  requireTheSame("fixed", record.fixed_name, fixed, record.fixed_points, record.fixed_origin);
  requireTheSame("moving", record.moving_name, moving, record.moving_points, record.moving_origin);
  const CloudStream stream(fixed);
  writePageOf(folder, record, pictures,
              report::pageScene(stream, moving, record.found, Eigen::Affine3d(record.guess)), "");
}

}  // namespace agricolmap
