#include "fuse_sources.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "agricolmap/batch/record.hpp"
#include "agricolmap/core/day.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_stream.hpp"
#include "agricolmap/io/cloud/move_file.hpp"
#include "agricolmap/io/crs/crs.hpp"
#include "agricolmap/io/las/las_writer.hpp"
#include "agricolmap/io/raster/map_files.hpp"
#include "agricolmap/report/json/registration_file.hpp"
#include "agricolmap/run/pair_files.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

namespace fs = std::filesystem;

/// The folder's name, which names the strip.
std::string idOf(const std::string& run) {
  const fs::path path = fs::absolute(run).lexically_normal();
  const fs::path name = path.has_filename() ? path.filename() : path.parent_path().filename();
  return name.string();
}

std::string storedName(const std::string& id) {
  return "strips/" + id + "." + io::endingOf(storedFormat());
}

std::map<std::string, std::int32_t> datesOf(const std::vector<std::string>& texts) {
  std::map<std::string, std::int32_t> dates;
  for (const std::string& text : texts) {
    const std::size_t equals = text.rfind('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError(fmt::format("--date {}: write STRIP=YYYY-MM-DD", text));
    }
    dates[text.substr(0, equals)] = dateNamed("--date", text.substr(equals + 1));
  }
  return dates;
}

/// The cloud that `register` laid, in one of the formats that it writes.
fs::path alignedIn(const std::string& run) {
  for (const std::string& name : run::alignedNames()) {
    std::error_code ignored;
    if (fs::is_regular_file(fs::path(run) / name, ignored)) return fs::path(run) / name;
  }
  throw InputError(fmt::format(
      "{}: there is no aligned cloud in it; register the pair again, of one that is not accepted "
      "with --keep-rejected",
      run));
}

std::optional<MapStrip> stripOf(const std::string& run, const FuseFiles& files, MapPlan& plan) {
  const report::StoredRegistration stored = report::readRegistration(run);
  if (!stored.accepted() && !files.force) {
    plan.warnings.push_back(
        fmt::format("{}: not fused, as its registration is {}: {} (--force fuses it nevertheless)",
                    run, stored.status, fmt::join(stored.reasons, "; ")));
    return std::nullopt;
  }
  if (!stored.fixed_from_moving) {
    throw InputError(fmt::format("{}: this registration has no answer: {}", run,
                                 fmt::join(stored.reasons, "; ")));
  }
  if (plan.crs.wkt.empty()) plan.crs = stored.crs;
  if (!stored.crs.wkt.empty() && stored.crs.wkt != plan.crs.wkt) {
    throw InputError(
        fmt::format("{}: was registered in {}, and the other strips in {}: one map has one "
                    "coordinate system; register it to the same fixed cloud",
                    run, stored.crs.name, plan.crs.name));
  }
  MapStrip strip;
  strip.source.id = idOf(run);
  strip.source.run = run;
  strip.source.status = stored.status;
  strip.source.heights_limited = stored.heights_limited;
  // What nobody knows is as good as the search: a strip of which that much is said owns little.
  constexpr double kUnknown = 1.0;
  strip.source.errors = {std::min(kUnknown, stored.plane_error),
                         std::min(kUnknown, stored.height_error)};
  if (const auto record = batch::readRecord(run)) strip.source.date = record->date;
  strip.cloud = alignedIn(run);
  return strip;
}

/// What the map has already, but for what goes.
void takeStored(const FuseFiles& files, const fs::path& map, MapPlan& plan) {
  const report::StoredMap stored = report::readSharedMap(map);
  if (fs::absolute(stored.fixed.file).lexically_normal() !=
      fs::absolute(files.fixed).lexically_normal()) {
    throw InputError(
        fmt::format("{}: is a map of {}, not of {}; name that, or make the map anew with --anew",
                    map.string(), stored.fixed.file, files.fixed));
  }
  plan.crs = stored.crs;
  plan.fixed.date = stored.fixed.date;
  for (const report::MapSource& source : stored.strips) plan.strips.push_back({source, {}});
  for (const std::string& id : files.remove) {
    const auto found = std::find_if(plan.strips.begin(), plan.strips.end(),
                                    [&](const MapStrip& strip) { return strip.source.id == id; });
    if (found == plan.strips.end()) {
      throw UsageError(fmt::format("--remove {}: {} has no such strip", id, map.string()));
    }
    plan.strips.erase(found);
  }
}

void checkDates(const std::map<std::string, std::int32_t>& dates, MapPlan& plan) {
  for (const auto& [id, date] : dates) {
    const auto found = std::find_if(plan.strips.begin(), plan.strips.end(),
                                    [&](const MapStrip& strip) { return strip.source.id == id; });
    if (found == plan.strips.end()) {
      throw UsageError(
          fmt::format("--date {}: there is no strip of that name; strips are called as the folders "
                      "of their registrations",
                      id));
    }
    found->source.date = date;
  }
}

}  // namespace

void FuseFiles::addTo(CLI::App& command) {
  command
      .add_option("FIXED", fixed,
                  "The wide map that strips were registered to: LAS, LAZ, PLY, PCD, lines of text, "
                  "or ORTHO.tif,DSM.tif")
      ->required();
  command.add_option("RUN_DIRS", runs,
                     "Folders with the results of register; a strip is called as its folder");
  command.add_option("--fixed-crs", fixed_crs,
                     "Coordinate system of FIXED: EPSG:32632, WKT or a file with it. Default: what "
                     "it says");
  command.add_option("--fixed-date", fixed_date, "Day of the flight, YYYY-MM-DD");
  command.add_option("--date", dates,
                     "Day of a drive, STRIP=YYYY-MM-DD, once per strip; of two strips that saw a "
                     "cell the later one has it");
  command.add_option("--remove", remove, "Strip to take out of the map, once or more");
  command.add_flag("--force", force, "Fuse registrations that were not accepted, too");
  command.add_flag("--anew", anew, "Forget the strips that the map has");
}

MapPlan planMap(const FuseFiles& files, const fs::path& map, bool overwrite) {
  MapPlan plan;
  const bool update = report::isSharedMap(map) && !files.anew;
  std::error_code ignored;
  if (!report::isSharedMap(map) && fs::exists(map, ignored) && !fs::is_empty(map, ignored) &&
      !overwrite) {
    throw OutputError(
        fmt::format("{}: is not empty and no shared map; name another folder, or use --overwrite",
                    map.string()));
  }
  if (!update && !files.remove.empty()) {
    throw UsageError(fmt::format("--remove: there is no map in {} yet", map.string()));
  }
  if (update) takeStored(files, map, plan);
  plan.fixed.id = "fixed";
  plan.fixed.file = files.fixed;
  if (!files.fixed_date.empty()) plan.fixed.date = dateNamed("--fixed-date", files.fixed_date);
  std::vector<std::string> named;
  for (const std::string& run : files.runs) {
    auto strip = stripOf(run, files, plan);
    if (!strip) continue;
    const std::string& id = strip->source.id;
    if (std::find(named.begin(), named.end(), id) != named.end()) {
      throw UsageError(
          fmt::format("{}: there is another strip called {}; rename one of the folders", run, id));
    }
    named.push_back(id);
    // A strip that comes again replaces the one of its name.
    std::erase_if(plan.strips, [&](const MapStrip& other) {
      if (other.source.id != id) return false;
      if (strip->source.date == 0) strip->source.date = other.source.date;
      return true;
    });
    plan.strips.push_back(*std::move(strip));
  }
  checkDates(datesOf(files.dates), plan);
  if (plan.strips.empty() && files.remove.empty()) {
    throw InputError(plan.warnings.empty()
                         ? "there is no strip to fuse; name the folders of registrations"
                         : fmt::format("there is no strip to fuse: {}", plan.warnings.front()));
  }
  std::sort(plan.strips.begin(), plan.strips.end(),
            [](const MapStrip& a, const MapStrip& b) { return a.source.id < b.source.id; });
  return plan;
}

MapClouds openClouds(const FuseFiles& files, MapPlan& plan, const io::SwappedFolder& folder) {
  MapClouds clouds;
  const io::MapFiles fixed = io::mapFilesOf(files.fixed);
  const io::FileCrs fixed_crs = io::crsOfMap(fixed, files.fixed_crs);
  io::CommonFrame frame = io::commonFrame(fixed_crs, fixed_crs);
  for (const std::string& warning : frame.warnings) plan.warnings.push_back(warning);
  if (!plan.crs.wkt.empty() && !frame.crs.wkt.empty() && plan.crs.wkt != frame.crs.wkt) {
    throw InputError(fmt::format(
        "{}: is in {}, and the strips were registered in {}; give the cloud that they were "
        "registered to, or say its coordinate system with --fixed-crs",
        files.fixed, frame.crs.name, plan.crs.name));
  }
  clouds.crs = frame.crs.wkt.empty() ? plan.crs : frame.crs;
  io::StreamOptions options;
  options.read.map = frame.fixed.get();
  options.read.marks = true;
  options.crs = clouds.crs;
  clouds.fixed = io::streamMap(fixed, options);
  plan.fixed.points = clouds.fixed->facts().points;
  for (MapStrip& strip : plan.strips) {
    if (strip.cloud.empty()) {
      folder.keep(strip.source.file);
    } else {
      strip.source.file = storedName(strip.source.id);
      io::CloudMove stay;
      stay.origin = clouds.fixed->facts().origin;
      stay.crs = clouds.crs;
      io::moveFile(strip.cloud, folder.path(strip.source.file), storedFormat(), stay);
    }
    io::StreamOptions of_strip;
    of_strip.crs = clouds.crs;
    of_strip.read.marks = true;
    of_strip.shown =
        strip.cloud.empty() ? folder.path(strip.source.file).shown() : strip.cloud.string();
    // Read from the folder that is being made, so that an update sees what the first run saw.
    clouds.strips.push_back(io::streamCloud(folder.path(strip.source.file).file(), of_strip));
    strip.source.points = clouds.strips.back()->facts().points;
  }
  return clouds;
}

io::CloudFormat storedFormat() {
  return io::hasLaz() ? io::CloudFormat::kLaz : io::CloudFormat::kLas;
}

std::int32_t dateNamed(const std::string& flag, const std::string& text) {
  if (const std::int32_t day = dayOf(text); day != 0) return day;
  throw UsageError(fmt::format("{} {}: is no day; write YYYY-MM-DD", flag, text));
}

}  // namespace agricolmap
