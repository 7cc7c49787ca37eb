// agricolmap apply RUN_DIR CLOUD... -o DIR
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/cloud/move_file.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/report/json/registration_file.hpp"
#include "agricolmap/run/pair_files.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

namespace fs = std::filesystem;

struct ApplyArguments {
  std::string run;
  std::vector<std::string> clouds;
  std::string output;
  std::string format = "auto";
  std::string crs;
  bool force = false;
};

/// One cloud on its way.
struct Job {
  std::string from;
  io::CloudFormat format = io::CloudFormat::kPly;
  std::string name;  ///< within the output folder
};

void refuseRaster(const std::string& cloud) {
  const io::MapFiles map = io::mapFilesOf(cloud);
  if (!map.raster) return;
  throw InputError(fmt::format(
      "{}: is a raster; only clouds are laid: write its points first (agricolmap convert "
      "{}{}{} points.laz)",
      cloud, map.main.string(), map.model ? " " : "", map.model.value_or(fs::path()).string()));
}

std::vector<Job> jobsOf(const ApplyArguments& arguments) {
  std::vector<Job> jobs;
  for (const std::string& cloud : arguments.clouds) {
    refuseRaster(cloud);
    const io::CloudFormat own = io::formatOf(cloud);
    Job job{cloud, own, fs::path(cloud).filename()};
    if (own == io::CloudFormat::kXyz) job.format = io::CloudFormat::kPly;
    if (arguments.format != "auto") job.format = run::formatNamed("--format", arguments.format);
    const auto named = io::formatByEnding(job.name);
    // LAZ that is called so may be COPC, whose order the result does not have.
    if (named != job.format) {
      const std::string ending = named ? "." + io::endingOf(*named) : "";
      job.name =
          job.name.substr(0, job.name.size() - ending.size()) + "." + io::endingOf(job.format);
    }
    for (const Job& other : jobs) {
      if (other.name != job.name) continue;
      throw UsageError(
          fmt::format("{} and {}: both would become {}; apply them one after the "
                      "other, to folders of their own",
                      other.from, cloud, job.name));
    }
    jobs.push_back(std::move(job));
  }
  return jobs;
}

void refuseToOverwriteInput(const std::vector<Job>& jobs, const std::string& output) {
  for (const Job& job : jobs) {
    for (const Job& other : jobs) {
      std::error_code ignored;
      if (!fs::equivalent(fs::path(output) / job.name, other.from, ignored)) continue;
      throw UsageError(
          fmt::format("{}: would be overwritten by the result of {}; name another "
                      "folder",
                      other.from, job.from));
    }
  }
}

void checkUsable(const report::StoredRegistration& run, const ApplyArguments& arguments) {
  if (!run.fixed_from_moving) {
    throw InputError(fmt::format("{}: this registration has no answer that could be applied: {}",
                                 arguments.run, fmt::join(run.reasons, "; ")));
  }
  if (run.accepted() || arguments.force) return;
  throw InputError(
      fmt::format("{}: this registration is {}, so the program does not stand for it: {}; apply it "
                  "nevertheless with --force",
                  arguments.run, run.status, fmt::join(run.reasons, "; ")));
}

/// What brings a cloud into the coordinates in which the moving cloud was registered.
io::CommonFrame frameOf(const std::string& cloud, const report::StoredRegistration& run,
                        const ApplyArguments& arguments) {
  io::FileCrs own = io::crsOf(cloud, arguments.crs);
  const std::string of_run = arguments.run + ": the registration";
  if (run.crs.wkt.empty()) {
    if (!own.crs) return {};
    if (!io::isInMetres(*own.crs)) {
      throw InputError(fmt::format(
          "{}: is in {}, and the registration does not say its coordinate system, so that nobody "
          "knows how to bring the cloud there; register again with --fixed-crs and --moving-crs",
          cloud, own.crs->name));
    }
    io::CommonFrame frame;
    frame.warnings = own.warnings;
    frame.warnings.push_back(
        fmt::format("{} does not say its coordinate system; taken as that of {} ({})", of_run,
                    cloud, own.crs->name));
    return frame;
  }
  if (!own.crs && run.moving_file_crs) {
    own.crs = run.moving_file_crs;
    own.warnings.push_back(fmt::format(
        "{}: it does not say its coordinate system; taken as that of the cloud that was registered "
        "({})",
        cloud, own.crs->name));
  }
  io::CommonFrame frame = io::commonFrame({of_run, run.crs, {}}, own);
  if (frame.crs.wkt.empty() && run.moving_file_crs && run.moving_file_crs->wkt != run.crs.wkt) {
    throw UsageError(fmt::format(
        "{}: the cloud was brought from {} to {}, which needs GDAL, and this build has none",
        of_run, run.moving_file_crs->name, run.crs.name));
  }
  frame.crs = run.crs;
  return frame;
}

io::PointMove moveOf(const report::StoredRegistration& run) {
  if (!run.deformation) return *run.fixed_from_moving;
  return {*run.fixed_from_moving, [&function = *run.deformation](const Eigen::Vector3d& point) {
            return function.at(point);
          }};
}

io::CopiedCloud apply(const Job& job, const report::StoredRegistration& run,
                      const ApplyArguments& arguments, const io::StagedOutput& output,
                      Progress& progress) {
  const io::CommonFrame frame = frameOf(job.from, run, arguments);
  printWarnings(frame.warnings);
  io::CopiedCloud copied = io::moveFile(
      job.from, output.path(job.name), job.format,
      {frame.moving.get(), run.moving_origin, moveOf(run), frame.crs}, progress.ofPasses());
  printWarnings(copied.warnings);
  warnOfLostCrs(job.name, job.format, frame.crs);
  return copied;
}

ExitCode runApply(const ApplyArguments& arguments, const Globals& globals) {
  if (arguments.format != "auto") run::formatNamed("--format", arguments.format);
  const report::StoredRegistration run = report::readRegistration(arguments.run);
  checkUsable(run, arguments);
  const std::vector<Job> jobs = jobsOf(arguments);
  refuseToOverwriteInput(jobs, arguments.output);
  io::StagedOutput output(arguments.output, globals.overwrite);
  std::vector<io::CopiedCloud> done;
  {
    Progress progress(globals);
    for (const Job& job : jobs) {
      progress.step(job.from);
      done.push_back(apply(job, run, arguments, output, progress));
    }
  }
  throwIfInterrupted();
  output.commit();
  if (globals.quiet) return ExitCode::kOk;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    fmt::print("{}: {} points, {} left out\n", (fs::path(arguments.output) / jobs[i].name).string(),
               done[i].points, done[i].left_out);
  }
  if (run.deformation) fmt::print("bent as the registration found it\n");
  return ExitCode::kOk;
}

}  // namespace

CommandSlot addApplyCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<ApplyArguments>();
  CLI::App* command = app.add_subcommand(
      "apply", "Lay clouds where a registration lays the cloud that was registered");
  command->add_option("RUN_DIR", arguments->run, "Folder with the results of register")->required();
  command
      ->add_option("CLOUDS", arguments->clouds,
                   "Clouds in the coordinates of MOVING: LAS, LAZ, PLY, PCD or lines of text")
      ->required();
  command->add_option("-o,--output", arguments->output, "Folder for the results")->required();
  command->add_option("--format", arguments->format,
                      "Format of the results: ply, pcd, las, laz, copc, or auto: as each cloud is, "
                      "ply of text [auto]");
  command->add_option("--crs", arguments->crs,
                      "Coordinate system of the clouds: EPSG:32632, WKT or a file with it, instead "
                      "of what they say. Default, where they do not: that of MOVING");
  command->add_flag("--force", arguments->force, "Apply a registration that was not accepted, too");
  return {command, [arguments, &globals] { return runApply(*arguments, globals); }};
}

}  // namespace agricolmap
