#include "agricolmap/batch/run/batch_run.hpp"

#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <new>
#include <set>
#include <tuple>
#include <utility>

#include "agricolmap/batch/memory.hpp"
#include "agricolmap/batch/picture/summary_page.hpp"
#include "agricolmap/batch/pool.hpp"
#include "agricolmap/batch/summary.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"

namespace agricolmap::batch {
namespace fs = std::filesystem;
namespace {

/// What a registration needs beside the strip's points, and each byte of the strip's file: decoded
/// points, maps and pyramids of them. Measured; what is wrong with it the pool finds out.
constexpr double kMemoryOfAny = 3e8;
constexpr double kMemoryPerByte = 6.0;
constexpr double kMemoryPerPackedByte = 24.0;
constexpr double kShareOfMemory = 0.8;  // of what is available

double memoryGuess(const Strip& strip) {
  std::error_code error;
  const fs::path file = io::mapFilesOf(strip.file).main;
  const auto bytes = static_cast<double>(fs::file_size(file, error));
  if (error) return kMemoryOfAny;
  const bool packed = file.extension() == ".laz" || file.extension() == ".tif";
  return kMemoryOfAny + bytes * (packed ? kMemoryPerPackedByte : kMemoryPerByte);
}

run::PairFiles filesOf(const Strip& strip, const MapEntry& map) {
  run::PairFiles files;
  files.fixed = map.file;
  files.moving = strip.file;
  files.fixed_crs = map.crs;
  files.moving_crs = strip.crs;
  files.aligned = strip.settings.aligned;
  return files;
}

/// An option as a flag of the program.
std::string flagOf(std::string path) {
  std::ranges::replace(path, '_', '-');
  return "--" + path;
}

/// The command that does the same for one strip.
std::string commandOf(const Strip& strip, const MapEntry& map, const fs::path& folder) {
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
  return run::commandText(words);
}

run::RegisterRun runOf(const Strip& strip, const MapEntry& map, const fs::path& folder,
                       const RunOptions& options) {
  run::RegisterRun run;
  run.files = filesOf(strip, map);
  run.prior = strip.prior;
  run.path = strip.path;
  run.keep_rejected = strip.settings.keep_rejected;
  run.pictures = strip.settings.pictures;
  run.preset = strip.settings.preset;
  run.options = strip.options;
  run.version = options.version;
  run.command_line = commandOf(strip, map, folder);
  run.threads = options.threads;
  return run;
}

/// What was made by something else than a batch is not to be replaced as a whole.
void requireOurs(const fs::path& folder) {
  if (!fs::exists(folder) || fs::exists(folder / kRecordName)) return;
  if (fs::is_directory(folder) && fs::is_empty(folder)) return;
  throw OutputError(
      fmt::format("{}: is there already and not of a batch; move it away", folder.string()));
}

/// Strips go to threads; what each of them does is not shared out any further, but by
/// threads that are left over.
int threadsBeside(std::size_t threads, std::size_t jobs) {
  return threads > jobs ? static_cast<int>(threads - jobs) + 1 : 1;
}

/// As a limit says, else one for each core.
std::size_t threadsInForce() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

void writeWhole(const fs::path& path, const std::string& text) {
  io::StagedFile file(path, true);
  io::writeText(file.path(), text);
  file.commit();
}

}  // namespace

double usualMemory() { return kShareOfMemory * availableMemory() + memoryInUse(); }

Batch::Batch(const Manifest& manifest, const RunOptions& options, const Listener& listener)
    : manifest_(manifest),
      options_(options),
      listener_(listener),
      outcomes_(manifest.strips.size()) {}

fs::path Batch::folderOf(std::size_t strip) const {
  return options_.output / manifest_.strips[strip].id;
}

/// Notes what is there already and as it would become again; returns the others.
std::vector<std::size_t> Batch::keepFinished(const std::vector<std::size_t>& strips) {
  std::vector<std::size_t> left;
  std::size_t there = 0;
  for (const std::size_t i : strips) {
    const fs::path folder = folderOf(i);
    std::optional<Record> record = fs::exists(folder) ? readRecord(folder) : std::nullopt;
    if (record) ++there;
    const bool kept = options_.resume && record &&
                      record->fingerprint == fingerprintOf(manifest_.strips[i], manifest_);
    if (kept) {
      outcomes_[i] = {std::move(record), ErrorKind::kInternal, true};
    } else {
      left.push_back(i);
    }
  }
  if (there > 0 && !options_.resume && !options_.overwrite) {
    throw OutputError(
        fmt::format("{}: {} of the strips have results already; keep those of which nothing has "
                    "changed, or do all again",
                    options_.output.string(), there),
        Remedy::kResumeOrOverwrite);
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
  progress_ = {0, left.size(), 0.0};
  watch_ = {};
  if (listener_.on_kept && left.size() < strips.size()) {
    listener_.on_kept(strips.size() - left.size(), strips.size());
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
    shared.on_pass = listener_.on_points;
    if (listener_.on_map) listener_.on_map(manifest_.maps[map].id);
    const auto fixed = prepare(here.empty() ? all : here, shared);
    shared.on_pass = {};
    if (grounds && fixed) {
      grounds_.push_back(groundOf(manifest_.maps[map].id, *fixed->points));
    }
    if (!here.empty()) runMap(here, shared);
    throwIfInterrupted();
  }
}

/// The map as its first strip sees it, on all threads, before strips share them. Nothing where it
/// cannot be read: its strips say so, each by itself.
std::shared_ptr<const run::LoadedFixed> Batch::prepare(const std::vector<std::size_t>& strips,
                                                       SharedFixed& shared) const {
  constexpr std::size_t kTries = 3;
  for (std::size_t i = 0; i < std::min(kTries, strips.size()); ++i) {
    const Strip& strip = manifest_.strips[strips[i]];
    try {
      const run::PairFiles files = filesOf(strip, manifest_.maps[strip.map]);
      const auto fixed = shared.get(io::mapFilesOf(files.fixed), run::frameOf(files));
      std::ignore = fixed->cloud.footprint(strip.options.level);
      if (listener_.on_map_warnings) listener_.on_map_warnings(fixed->cloud.facts().warnings);
      return fixed;
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      detail(strip.id, error.what());
    }
  }
  return nullptr;
}

void Batch::runMap(const std::vector<std::size_t>& strips, SharedFixed& shared) {
  const std::size_t threads = threadsInForce();
  const std::size_t most = options_.jobs > 0 ? options_.jobs : threads;
  const std::size_t jobs = std::min(most, strips.size());
  const double memory = options_.memory > 0.0 ? options_.memory : usualMemory();
  const ThreadLimit limit(threadsBeside(threads, jobs));
  PoolWork work;
  work.count = strips.size();
  work.estimate = [&](std::size_t i) { return memoryGuess(manifest_.strips[strips[i]]); };
  work.memory_in_use = memoryInUse;
  work.work = [&](std::size_t i) { doStrip(strips[i], shared); };
  runPool(work, {jobs, memory}, options_.stop);
}

/// Registers a strip and puts its results in place.
Record Batch::registered(std::size_t index, SharedFixed& shared) const {
  const Strip& strip = manifest_.strips[index];
  const fs::path folder = folderOf(index);
  Record record = recordOf(strip, manifest_);
  record.fingerprint = fingerprintOf(strip, manifest_);
  requireOurs(folder);
  io::StagedOutput output(folder, io::Existing::kReplace);
  Monitor monitor(options_.stop);
  const run::FixedSource fixed = [&](const io::MapFiles& files, const io::CommonFrame& frame) {
    return shared.get(files, frame);
  };
  // They are in the report; of thousands of strips nobody reads them here.
  const run::Say say = [&](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) detail(strip.id, warning);
  };
  const run::RegisterRun asked = runOf(strip, manifest_.maps[strip.map], folder, options_);
  const run::RegisterResult found = run::registerInto(asked, fixed, output, monitor, say);
  const auto& placed = found.registration.placed;
  setVerdict(found.registration.verdict,
             placed ? placed->uncertainty : std::optional<verdict::PoseUncertainty>(), record);
  record.outline = found.outline;
  record.seconds = monitor.seconds();
  writeRecord(output.path(kRecordName), record);
  output.commit();
  return record;
}

void Batch::doStrip(std::size_t index, SharedFixed& shared) {
  const StopScope scope(options_.stop);
  Record record;
  ErrorKind kind = ErrorKind::kInternal;
  const auto failed = [&](const std::string& what, ErrorKind why) {
    record = recordOf(manifest_.strips[index], manifest_);
    record.message = what;
    kind = why;
    // A disk that is not there for an hour must not cost what was made of all strips before.
    std::error_code ignored;
    if (!fs::exists(folderOf(index) / kRecordName, ignored)) return;
    record.message += "; the results of an earlier run stay";
  };
  try {
    record = registered(index, shared);
  } catch (const Interrupted&) {
    return;
  } catch (const Error& error) {
    failed(error.what(), error.kind());
  } catch (const std::bad_alloc&) {
    failed("out of memory; crop the strip or enlarge grid.cell", ErrorKind::kInternal);
  } catch (const std::exception& error) {
    failed(error.what(), ErrorKind::kInternal);
  }
  tell(index, std::move(record), kind);
}

/// Notes what became of a strip and says it.
void Batch::tell(std::size_t index, Record record, ErrorKind error) {
  const std::scoped_lock lock(mutex_);
  ++progress_.worked;
  progress_.seconds = watch_.seconds();
  outcomes_[index] = {std::move(record), error, false};
  if (listener_.on_strip) listener_.on_strip(*outcomes_[index].record, progress_);
}

void Batch::detail(const std::string& strip, const std::string& text) const {
  if (!listener_.on_detail) return;
  const std::scoped_lock lock(mutex_);
  listener_.on_detail(strip, text);
}

void Batch::writeSummary(double seconds) const {
  std::vector<Record> records;
  for (const StripOutcome& outcome : outcomes_) {
    if (outcome.record) records.push_back(*outcome.record);
  }
  const fs::path& folder = options_.output;
  writeWhole(folder / "summary.csv", csvOf(records));
  writeWhole(folder / "summary.json", jsonOf(records, manifest_, seconds));
  writeWhole(folder / "summary.html", summaryPage(records, manifest_, seconds));
  if (grounds_.empty()) return;
  io::StagedFile picture(folder / "summary.png", true);
  writeSummaryPicture(picture.path(), grounds_, records);
  picture.commit();
}

}  // namespace agricolmap::batch
