#include "agricolmap/run/register_run.hpp"

#include <algorithm>

#include "agricolmap/config/json.hpp"
#include "agricolmap/core/convex_hull.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/path_file.hpp"
#include "agricolmap/pipeline/followed.hpp"
#include "agricolmap/report/json/registration_json.hpp"
#include "agricolmap/report/page/registration_page.hpp"
#include "agricolmap/report/pictures/pictures.hpp"

namespace agricolmap::run {
namespace {

report::RegistrationReportInfo reportInfo(const RegisterRun& run) {
  report::RegistrationReportInfo info;
  info.version = run.version;
  info.threads = run.threads;
  info.command_line = run.command_line;
  info.preset = run.preset;
  pipeline::RegistrationOptions options = run.options;
  info.options = config::toJson(optionTable(options));
  info.seed = static_cast<std::uint64_t>(run.options.seed);
  return info;
}

/// Where the registration puts points of the moving file.
io::PointMove moveOf(const pipeline::Registration& result, const Cloud& moving) {
  const Eigen::Affine3d& fixed_from_moving = result.transform->fixed_from_moving;
  if (!result.bent()) return fixed_from_moving;
  return {fixed_from_moving, [function = pipeline::Displacement(result, moving).function()](
                                 const Eigen::Vector3d& point) { return function.at(point); }};
}

/// Fills `output` with everything but the report; returns the names of the pictures.
std::vector<std::string> writeResults(const RegisterRun& run, const LoadedPair& pair,
                                      const pipeline::Registration& result,
                                      const io::StagedOutput& output, Monitor& monitor,
                                      const Say& say) {
  const bool keep = result.transform &&
                    (result.verdict.status == verdict::Status::kAccepted || run.keep_rejected);
  if (keep) {
    monitor.run(Stage::kWrite, [&] {
      const Eigen::Affine3d& fixed_from_moving = result.transform->fixed_from_moving;
      io::writeMatrix(output.path("transform.txt"), fixed_from_moving, transformComment(pair));
      const auto warnings = writeAligned(run.files, pair, moveOf(result, pair.moving), output);
      say(warnings);
      for (const std::string& warning : warnings) monitor.warn(warning);
    });
  }
  if (!run.pictures) return {};
  return monitor.run(Stage::kPictures, [&] {
    return report::writePictures(output.folder(), result,
                                 {run.files.fixed, run.files.moving, run.options.evidence});
  });
}

/// registration.json and report.html, which holds it.
void writeReports(const RegisterRun& run, const LoadedPair& pair,
                  const pipeline::Registration& result, const report::RegistrationReportInfo& info,
                  const io::StagedOutput& output, Monitor& monitor) {
  const PointStream& fixed = *pair.fixed->points;
  report::PageContent page;
  std::string missing;
  if (run.pictures) {
    page.scene = monitor.run(Stage::kPictures, [&] {
      return report::pageScene(fixed, pair.moving, result, info.prior);
    });
  } else {
    missing = "the registration was run without pictures";
  }
  page.facts = report::pageFacts({fixed.facts().origin, pair.moving.origin}, result, run.options,
                                 run.preset, missing);
  page.report = report::registrationJson(fixed, pair.moving, result, monitor, info);
  io::writeText(output.path("registration.json"), page.report.dump(2) + "\n");
  report::writeRegistrationPage(output.path(report::kPageName), page);
}

/// By points spread over the strip, strays left out.
std::vector<Eigen::Vector2d> outlineOf(const pipeline::Registration& result, const Cloud& moving,
                                       const Eigen::Affine3d& guess) {
  constexpr std::size_t kSamples = 20'000;
  const Eigen::Affine3d file_from_local =
      (result.transform ? result.transform->fixed_from_moving : guess) *
      Eigen::Translation3d(moving.origin);
  std::vector<Eigen::Vector2d> points;
  const std::size_t stride = std::max<std::size_t>(1, moving.size() / kSamples);
  for (std::size_t i = 0; i < moving.size(); i += stride) {
    const Eigen::Vector3d p = moving.xyz[i].cast<double>();
    const Eigen::Vector3d levelled = result.maps.frames.levelled_from_moving * p;
    if (!result.maps.moving_box.contains(levelled.head<2>())) continue;
    points.emplace_back((file_from_local * p).head<2>());
  }
  return convexHull(std::move(points));
}

}  // namespace

RegisterResult registerInto(const RegisterRun& run, const FixedSource& fixed,
                            const io::StagedOutput& output, Monitor& monitor, const Say& say) {
  report::RegistrationReportInfo info = reportInfo(run);
  info.prior =
      initialGuess(io::mapFilesOf(run.files.fixed).main, io::mapFilesOf(run.files.moving).main,
                   run.prior, info.prior_source, say);
  const LoadedPair pair = monitor.run(Stage::kRead, [&] { return loadPair(run.files, fixed); });
  info.fixed_file_crs = pair.frame.fixed_file;
  info.moving_file_crs = pair.frame.moving_file;
  for (const std::string& warning : pair.frame.warnings) monitor.warn(warning);
  say(pair.fixed->cloud.facts().warnings);
  say(pair.moving.warnings);
  const std::vector<Eigen::Vector3d> path =
      run.path.empty() ? std::vector<Eigen::Vector3d>{} : io::readPath(run.path);
  RegisterResult result;
  result.registration = pipeline::registerClouds(pair.fixed->cloud, pair.moving, info.prior,
                                                 run.options, monitor, {}, path);
  const pipeline::Registration& found = result.registration;
  say(monitor.warnings());
  info.pictures = writeResults(run, pair, found, output, monitor, say);
  writeReports(run, pair, found, info, output, monitor);
  throwIfInterrupted();
  result.outline = outlineOf(found, pair.moving, info.prior);
  return result;
}

std::vector<std::string> staleResults() {
  std::vector<std::string> stale = report::pictureNames();
  stale.emplace_back("transform.txt");
  stale.emplace_back(report::kPageName);
  for (const std::string& name : alignedNames()) stale.push_back(name);
  return stale;
}

std::string commandText(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    const bool plain =
        !word.empty() && word.find_first_of(" \t\n'\"\\$`*?&|;<>()[]{}#~!") == std::string::npos;
    if (plain) {
      text += word;
      continue;
    }
    text += '\'';
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    text += '\'';
  }
  return text;
}

}  // namespace agricolmap::run
