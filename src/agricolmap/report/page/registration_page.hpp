// report.html: a registration for the one who must decide whether to trust it, as one page that
// works by itself, without a network and beside no other file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "agricolmap/core/monitor.hpp"
#include "agricolmap/io/output/output_path.hpp"
#include "agricolmap/report/json/registration_json.hpp"
#include "agricolmap/report/page/page.hpp"

namespace agricolmap::report {

inline constexpr const char* kPageName = "report.html";

/// The maps and points of a page, which take a pass over both clouds; nothing in a build that
/// cannot draw.
nlohmann::ordered_json pageScene(const PointStream& fixed, const Cloud& moving,
                                 const pipeline::Registration& registration,
                                 const Eigen::Affine3d& guess);

/// Zeros of the clouds' local coordinates, in those of their files [m].
struct CloudOrigins {
  Eigen::Vector3d fixed = Eigen::Vector3d::Zero();
  Eigen::Vector3d moving = Eigen::Vector3d::Zero();
};

/// The facts of a page: words, blocks, options, the nearest rigid transform. `scene_missing`: why
/// there are no maps and points, in words; empty where there are.
nlohmann::ordered_json pageFacts(const CloudOrigins& origins,
                                 const pipeline::Registration& registration,
                                 const pipeline::RegistrationOptions& options,
                                 const std::string& preset, const std::string& scene_missing);

/// The whole page, UTF-8.
std::string registrationPage(const PageContent& content);

/// Writes it. Throws OutputError.
void writeRegistrationPage(const io::OutputPath& path, const PageContent& content);

}  // namespace agricolmap::report
