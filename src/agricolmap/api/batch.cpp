#include "agricolmap/batch.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <stop_token>
#include <utility>

#include "agricolmap/api/checks.hpp"
#include "agricolmap/batch/run/batch_run.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/report/pictures/pictures.hpp"
#include "agricolmap/version.hpp"

namespace agricolmap {
namespace {

std::optional<double> known(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::optional<Registration::Status> statusOf(const std::string& text) {
  for (const auto status : {Registration::Status::kAccepted, Registration::Status::kRejected,
                            Registration::Status::kAmbiguous}) {
    if (text == toString(status)) return status;
  }
  return std::nullopt;
}

BatchStrip publicStrip(const batch::Record& record, std::filesystem::path folder, bool kept) {
  BatchStrip strip;
  strip.id = record.id;
  strip.map = record.map;
  strip.folder = std::move(folder);
  strip.status = statusOf(record.status);
  strip.plane_probability = record.probability;
  strip.expected_rms_m = known(record.expected_error);
  strip.heights_measured = record.heights == "measured";
  strip.height_deviation_m = known(record.height_error);
  strip.seconds = record.seconds;
  strip.date = record.date;
  strip.message = record.message;
  strip.kept = kept;
  strip.outline = record.outline;
  return strip;
}

/// What the command line's flags cannot say, callers can.
void requireSettings(const BatchSettings& settings) {
  if (settings.jobs < 0) throw UsageError("jobs: is below 0; 0 means as many as threads");
  if (!(settings.memory_bytes >= 0.0)) throw UsageError("memory: is below 0; give bytes");
  const bool whole = settings.shard == 0 && settings.shards == 0;
  if (!whole && (settings.shard < 1 || settings.shard > settings.shards)) {
    throw UsageError(fmt::format("shard: is {} of {}; must be from 1 to their number",
                                 settings.shard, settings.shards));
  }
  if (!whole && !settings.items.empty()) throw UsageError("items and shard do not go together");
}

batch::Manifest manifestOf(const std::filesystem::path& file, const BatchSettings& settings) {
  batch::Manifest manifest =
      settings.text ? batch::manifestOf(*settings.text, file) : batch::readManifest(file);
  for (batch::Strip& strip : manifest.strips) {
    if (!settings.pictures) strip.settings.pictures = false;
    if (strip.settings.pictures && !report::canDraw()) {
      throw UsageError(fmt::format(
          "{}: pictures need Cairo, which this library was built without; say pictures: false",
          strip.id));
    }
  }
  return manifest;
}

std::vector<std::size_t> chosenOf(const batch::Manifest& manifest, const BatchSettings& settings) {
  if (!settings.items.empty()) return batch::stripsCalled(settings.items, manifest, "item");
  if (settings.shards == 0) return batch::allStrips(manifest);
  return batch::shardOf(manifest, static_cast<std::size_t>(settings.shard),
                        static_cast<std::size_t>(settings.shards));
}

batch::RunOptions runOptions(const std::filesystem::path& output, const BatchSettings& settings,
                             int threads, const std::stop_token& stop) {
  batch::RunOptions options;
  options.output = output;
  options.resume = settings.resume;
  options.overwrite = settings.overwrite;
  options.jobs = static_cast<std::size_t>(settings.jobs);
  options.memory = settings.memory_bytes;
  options.pictures = settings.pictures;
  options.threads = threads;
  options.version = version();
  options.stop = stop;
  return options;
}

/// The caller's listener. What it throws must not end a thread of the batch: it stops the batch
/// and is thrown when that has ended.
struct Hearing {
  const StripListener& listener;
  const std::filesystem::path& output;
  std::stop_source& stop;
  std::exception_ptr raised = nullptr;

  void tell(const batch::Record& record, const batch::Progress& progress) {
    if (!listener || raised) return;
    try {
      listener(publicStrip(record, output / record.id, false), progress.worked, progress.todo);
    } catch (...) {
      raised = std::current_exception();
      stop.request_stop();
    }
  }
};

}  // namespace

std::vector<BatchStrip> registerBatch(const std::filesystem::path& manifest_file,
                                      const std::filesystem::path& output,
                                      const BatchSettings& settings, const Control& control,
                                      const StripListener& on_strip) {
  requireProcessor();
  requireSettings(settings);
  const ThreadLimit limit = threadLimit(control);
  std::stop_source stop;
  const std::stop_callback passed_on(control.stop, [&] { stop.request_stop(); });
  const StopScope scope(stop.get_token());
  const batch::Manifest manifest = manifestOf(manifest_file, settings);
  const std::vector<std::size_t> chosen = chosenOf(manifest, settings);
  const batch::RunOptions options = runOptions(output, settings, control.threads, stop.get_token());
  Hearing hears{on_strip, output, stop};
  batch::Listener listener;
  listener.on_strip = [&](const batch::Record& record, const batch::Progress& progress) {
    hears.tell(record, progress);
  };
  const Stopwatch watch;
  batch::Batch batch(manifest, options, listener);
  const bool whole = settings.items.empty() && settings.shards == 0;
  try {
    batch.run(chosen, whole && options.pictures && report::canDraw());
    throwIfInterrupted();
  } catch (const Interrupted&) {
    if (hears.raised) std::rethrow_exception(hears.raised);
    throw;
  }
  if (hears.raised) std::rethrow_exception(hears.raised);
  if (whole) batch.writeSummary(watch.seconds());
  std::vector<BatchStrip> strips;
  for (const std::size_t i : chosen) {
    const batch::StripOutcome& outcome = batch.outcomes()[i];
    strips.push_back(publicStrip(*outcome.record, batch.folderOf(i), outcome.kept));
  }
  return strips;
}

}  // namespace agricolmap
