#include "batch_run.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <new>
#include <set>
#include <tuple>
#include <utility>

#include "agricolmap/batch/memory.hpp"
#include "agricolmap/batch/pool.hpp"
#include "agricolmap/batch/summary.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/tiled_stream.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "option_flags.hpp"
#include "register_run.hpp"

namespace agricolmap {
namespace fs = std::filesystem;
namespace {

/// What a registration needs beside the strip's points, and each byte of the strip's file: decoded
/// points, maps and pyramids of them. Measured; what is wrong with it the pool finds out.
constexpr double kMemoryOfAny = 3e8;
constexpr double kMemoryPerByte = 6.0;
constexpr double kMemoryPerPackedByte = 24.0;
constexpr std::size_t kWidestId = 40;

double memoryGuess(const batch::Strip& strip) {
  std::error_code error;
  const fs::path file = io::mapFilesOf(strip.file).main;
  const auto bytes = static_cast<double>(fs::file_size(file, error));
  if (error) return kMemoryOfAny;
  const bool packed = file.extension() == ".laz" || file.extension() == ".tif";
  return kMemoryOfAny + bytes * (packed ? kMemoryPerPackedByte : kMemoryPerByte);
}

PairFiles filesOf(const batch::Strip& strip, const batch::MapEntry& map) {
  PairFiles files;
  files.fixed = map.file;
  files.moving = strip.file;
  files.fixed_crs = map.crs;
  files.moving_crs = strip.crs;
  files.aligned = strip.settings.aligned;
  return files;
}

/// The command that does the same for one strip.
std::string commandOf(const batch::Strip& strip, const batch::MapEntry& map,
                      const fs::path& folder) {
  std::vector<std::string> words = {"agricolmap", "register", map.file,
                                    strip.file,   "-o",       folder.string()};
  const auto add = [&](const char* flag, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {flag, value});
  };
  add("--fixed-crs", map.crs);
  add("--moving-crs", strip.crs);
  add("--prior", strip.prior);
  add("--path", strip.path);
  if (strip.settings.preset != "default") add("--preset", strip.settings.preset);
  if (strip.settings.aligned != "auto") add("--aligned-format", strip.settings.aligned);
  if (strip.settings.keep_rejected) words.emplace_back("--keep-rejected");
  if (!strip.settings.pictures) words.emplace_back("--no-pictures");
  for (const auto& [path, text] : strip.settings.options) {
    words.push_back(fmt::format("{}={}", flagOf(path), text));
  }
  return commandText(words);
}

RegisterRun runOf(const batch::Strip& strip, const batch::MapEntry& map, const fs::path& folder,
                  const Globals& globals) {
  RegisterRun run;
  run.files = filesOf(strip, map);
  run.prior = strip.prior;
  run.path = strip.path;
  run.keep_rejected = strip.settings.keep_rejected;
  run.pictures = strip.settings.pictures;
  run.preset = strip.settings.preset;
  run.options = strip.options;
  run.command_line = commandOf(strip, map, folder);
  run.threads = globals.threads;
  return run;
}

/// What was made by something else than a batch is not to be replaced as a whole.
void requireOurs(const fs::path& folder) {
  if (!fs::exists(folder) || fs::exists(folder / batch::kRecordName)) return;
  if (fs::is_directory(folder) && fs::is_empty(folder)) return;
  throw OutputError(
      fmt::format("{}: is there already and not of a batch; move it away", folder.string()));
}

/// Strips go to threads; what each of them does is not shared out any further, but by
/// threads that are left over.
int threadsBeside(std::size_t threads, std::size_t jobs) {
  return threads > jobs ? static_cast<int>(threads - jobs) + 1 : 1;
}

}  // namespace

std::size_t threadsInForce() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

std::shared_ptr<const LoadedFixed> SharedFixed::get(const io::MapFiles& files,
                                                    const io::CommonFrame& frame) {
  const std::string key = fmt::format(
      "{}\n{}\n{}\n{}\n{}", files.main.string(), files.model.value_or("").string(), frame.crs.wkt,
      frame.fixed_file ? frame.fixed_file->wkt : "", frame.fixed != nullptr);
  const std::scoped_lock lock(mutex_);
  const auto [found, is_new] = entries_.try_emplace(key);
  Entry& entry = found->second;
  if (is_new) {
    try {
      io::StreamOptions options;
      options.read.map = frame.fixed.get();
      options.on_pass = on_pass;
      options.crs = frame.crs;
      const auto stream = io::streamMap(files, options);
      entry.fixed = std::make_shared<const LoadedFixed>(std::make_unique<io::TiledStream>(*stream));
    } catch (...) {
      entry.error = std::current_exception();
    }
  }
  if (entry.error) std::rethrow_exception(entry.error);
  return entry.fixed;
}

Batch::Batch(const batch::Manifest& manifest, const BatchOptions& options, const Globals& globals)
    : manifest_(manifest),
      options_(options),
      globals_(globals),
      progress_(globals),
      outcomes_(manifest.strips.size()) {
  for (const batch::Strip& strip : manifest.strips) {
    id_width_ = std::clamp(strip.id.size(), id_width_, kWidestId);
  }
}

fs::path Batch::folderOf(std::size_t strip) const {
  return options_.output / manifest_.strips[strip].id;
}

/// Notes what is there already and as it would become again; returns the others.
std::vector<std::size_t> Batch::keepFinished(const std::vector<std::size_t>& strips) {
  std::vector<std::size_t> left;
  std::size_t there = 0;
  for (const std::size_t i : strips) {
    const fs::path folder = folderOf(i);
    std::optional<batch::Record> record =
        fs::exists(folder) ? batch::readRecord(folder) : std::nullopt;
    if (record) ++there;
    const bool kept = options_.resume && record &&
                      record->fingerprint == batch::fingerprintOf(manifest_.strips[i], manifest_);
    if (kept) {
      outcomes_[i] = {std::move(record), ExitCode::kOk, true};
    } else {
      left.push_back(i);
    }
  }
  if (there > 0 && !options_.resume && !globals_.overwrite) {
    throw OutputError(fmt::format(
        "{}: {} of the strips have results already; --resume keeps those of which nothing has "
        "changed, --overwrite does all again",
        options_.output.string(), there));
  }
  return left;
}

/// What killed runs left of these strips and, where they are all there are, of the summary.
void Batch::removeLeftovers(const std::vector<std::size_t>& strips) const {
  std::set<std::string> ids;
  for (const std::size_t i : strips) ids.insert(manifest_.strips[i].id);
  if (strips.size() == manifest_.strips.size()) {
    ids.insert({"summary.csv", "summary.json", "summary.html", "summary.png"});
  }
  std::error_code error;
  std::vector<fs::path> leftovers;
  for (const fs::directory_entry& entry : fs::directory_iterator(options_.output, error)) {
    if (ids.contains(io::targetOfHidden(entry.path().filename().string()))) {
      leftovers.push_back(entry.path());
    }
  }
  for (const fs::path& path : leftovers) fs::remove_all(path, error);
}

void Batch::run(const std::vector<std::size_t>& strips, bool grounds) {
  const std::vector<std::size_t> left = keepFinished(strips);
  // Before hours of work of which nothing could be kept.
  if (!left.empty()) std::ignore = io::StagedOutput(options_.output, true);
  removeLeftovers(strips);
  todo_ = left.size();
  watch_ = {};
  if (!globals_.quiet && left.size() < strips.size()) {
    fmt::print("{} of {} strips are done already\n", strips.size() - left.size(), strips.size());
  }
  for (std::size_t map = 0; map < manifest_.maps.size(); ++map) {
    const auto of = [&](const std::vector<std::size_t>& from) {
      std::vector<std::size_t> some;
      std::copy_if(from.begin(), from.end(), std::back_inserter(some),
                   [&](std::size_t i) { return manifest_.strips[i].map == map; });
      return some;
    };
    const std::vector<std::size_t> here = of(left);
    const std::vector<std::size_t> all = of(strips);
    if (here.empty() && !(grounds && !all.empty())) continue;
    SharedFixed shared;
    shared.on_pass = progress_.ofPasses();
    progress_.step(fmt::format("map {}", manifest_.maps[map].id));
    const auto fixed = prepare(here.empty() ? all : here, shared);
    shared.on_pass = {};
    if (grounds && fixed) {
      grounds_.push_back(batch::groundOf(manifest_.maps[map].id, *fixed->points));
    }
    if (!here.empty()) runMap(here, shared);
    throwIfInterrupted();
  }
}

/// The map as its first strip sees it, on all threads, before strips share them. Nothing where it
/// cannot be read: its strips say so, each by itself.
std::shared_ptr<const LoadedFixed> Batch::prepare(const std::vector<std::size_t>& strips,
                                                  SharedFixed& shared) {
  constexpr std::size_t kTries = 3;
  for (std::size_t i = 0; i < std::min(kTries, strips.size()); ++i) {
    const batch::Strip& strip = manifest_.strips[strips[i]];
    try {
      const PairFiles files = filesOf(strip, manifest_.maps[strip.map]);
      const auto fixed = shared.get(io::mapFilesOf(files.fixed), frameOf(files));
      std::ignore = fixed->cloud.footprint(strip.options.level);
      printWarnings(fixed->cloud.facts().warnings);
      return fixed;
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      spdlog::debug("{}: {}", strip.id, error.what());
    }
  }
  return nullptr;
}

void Batch::runMap(const std::vector<std::size_t>& strips, SharedFixed& shared) {
  const std::size_t jobs = std::min(options_.jobs, strips.size());
  const ThreadLimit limit(threadsBeside(threadsInForce(), jobs));
  batch::PoolWork work;
  work.count = strips.size();
  work.estimate = [&](std::size_t i) { return memoryGuess(manifest_.strips[strips[i]]); };
  work.memory_in_use = batch::memoryInUse;
  work.work = [&](std::size_t i) { doStrip(strips[i], shared); };
  batch::runPool(work, {jobs, options_.memory}, globals_.stop);
}

/// Registers a strip and puts its results in place.
batch::Record Batch::registered(std::size_t index, SharedFixed& shared) const {
  const batch::Strip& strip = manifest_.strips[index];
  const fs::path folder = folderOf(index);
  batch::Record record = batch::recordOf(strip, manifest_);
  record.fingerprint = batch::fingerprintOf(strip, manifest_);
  requireOurs(folder);
  io::StagedOutput output(folder, io::Existing::kReplace);
  Monitor monitor(globals_.stop);
  const FixedSource fixed = [&](const io::MapFiles& files, const io::CommonFrame& frame) {
    return shared.get(files, frame);
  };
  // They are in the report; of thousands of strips nobody reads them here.
  const Say say = [&](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) spdlog::debug("{}: {}", strip.id, warning);
  };
  const RegisterRun run = runOf(strip, manifest_.maps[strip.map], folder, globals_);
  const RegisterResult found = registerInto(run, fixed, output, monitor, say);
  const auto& placed = found.registration.placed;
  batch::setVerdict(found.registration.verdict,
                    placed ? placed->uncertainty : std::optional<verdict::PoseUncertainty>(),
                    record);
  record.outline = found.outline;
  record.seconds = monitor.seconds();
  batch::writeRecord(output.path(batch::kRecordName), record);
  output.commit();
  return record;
}

void Batch::doStrip(std::size_t index, SharedFixed& shared) {
  const StopScope scope(globals_.stop);
  const auto failed = [&](const std::string& what, ExitCode code) {
    batch::Record record = batch::recordOf(manifest_.strips[index], manifest_);
    record.message = what;
    tell(index, std::move(record), code);
  };
  try {
    tell(index, registered(index, shared), ExitCode::kOk);
  } catch (const Interrupted&) {
    return;
  } catch (const Error& error) {
    failed(error.what(), exitCodeOf(error.kind()));
  } catch (const std::bad_alloc&) {
    failed("out of memory; crop the strip or enlarge grid.cell", ExitCode::kInternal);
  } catch (const std::exception& error) {
    failed(error.what(), ExitCode::kInternal);
  }
}

/// Notes what became of a strip and says it.
void Batch::tell(std::size_t index, batch::Record record, ExitCode code) {
  const std::scoped_lock lock(mutex_);
  ++worked_;
  if (!globals_.quiet) {
    progress_.clear();
    fmt::print("{}\n", batch::lineOf(record, id_width_));
    std::fflush(stdout);
  }
  outcomes_[index] = {std::move(record), code, false};
  const double each = watch_.seconds() / static_cast<double>(worked_);
  progress_.step(fmt::format("{} of {} strips, {:.1f} s each, {:.0f} min left", worked_, todo_,
                             each, each * static_cast<double>(todo_ - worked_) / 60.0));
}

}  // namespace agricolmap
