// The strips of a batch, registered side by side: each to a folder that appears whole or not at
// all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "agricolmap/batch/manifest.hpp"
#include "agricolmap/batch/picture/summary_picture.hpp"
#include "agricolmap/batch/record.hpp"
#include "agricolmap/batch/run/shared_fixed.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/run/register_run.hpp"

namespace agricolmap::batch {

struct RunOptions {
  std::filesystem::path output;
  bool resume = false;     ///< keep folders of which nothing has changed
  bool overwrite = false;  ///< replace those that are there
  std::size_t jobs = 0;    ///< strips at once; 0: as many as threads
  double memory = 0.0;     ///< that all may take [bytes]; 0: usualMemory
  bool pictures = true;    ///< of the whole; strips have settings of their own
  int threads = 0;         ///< as it was asked for, for reports
  std::string version;     ///< likewise
  std::stop_token stop;
};

/// Four fifths of what is available, and what the process has already [bytes].
double usualMemory();

/// What became of a strip.
struct StripOutcome {
  std::optional<Record> record;            ///< nothing: not looked at, or interrupted
  ErrorKind error = ErrorKind::kInternal;  ///< of one that failed
  bool kept = false;                       ///< was there already
};

/// How far it is.
struct Progress {
  std::size_t worked = 0;  ///< strips registered now
  std::size_t todo = 0;    ///< of so many
  double seconds = 0.0;    ///< since the first was begun
};

/// Hears how it goes on, one call at a time, from several threads. Any may be empty.
struct Listener {
  std::function<void(std::size_t kept, std::size_t of)> on_kept;
  std::function<void(const std::string& map)> on_map;
  std::function<void(std::size_t seen, std::size_t of)> on_points;  ///< of a map's pass
  run::Say on_map_warnings;
  /// What strips' reports have, too.
  std::function<void(const std::string& strip, const std::string& text)> on_detail;
  std::function<void(const Record& record, const Progress& progress)> on_strip;
};

class Batch {
 public:
  /// All must outlive it.
  Batch(const Manifest& manifest, const RunOptions& options, const Listener& listener);

  /// Registers these strips, map by map. Throws OutputError when one of them has results already
  /// that are neither to be kept nor replaced, Interrupted; what was done stays. `grounds`: whether
  /// maps are to be drawn.
  void run(const std::vector<std::size_t>& strips, bool grounds);

  const std::vector<StripOutcome>& outcomes() const { return outcomes_; }
  std::filesystem::path folderOf(std::size_t strip) const;
  /// summary.csv, .json and .html of all strips, and the picture where maps were drawn.
  void writeSummary(double seconds) const;

 private:
  std::vector<std::size_t> keepFinished(const std::vector<std::size_t>& strips);
  void removeLeftovers(const std::vector<std::size_t>& strips) const;
  void runMap(const std::vector<std::size_t>& strips, SharedFixed& shared);
  std::shared_ptr<const run::LoadedFixed> prepare(const std::vector<std::size_t>& strips,
                                                  SharedFixed& shared) const;
  void doStrip(std::size_t strip, SharedFixed& shared);
  Record registered(std::size_t strip, SharedFixed& shared) const;
  void tell(std::size_t strip, Record record, ErrorKind error);
  void detail(const std::string& strip, const std::string& text) const;

  const Manifest& manifest_;
  const RunOptions& options_;
  const Listener& listener_;
  mutable std::mutex mutex_;  ///< of what follows, and the listener, while strips run
  std::vector<StripOutcome> outcomes_;
  std::vector<MapGround> grounds_;
  Progress progress_;
  Stopwatch watch_;
};

/// All strips of a manifest; every `parts`-th from the `part`-th on, counted from 1.
std::vector<std::size_t> allStrips(const Manifest& manifest);
std::vector<std::size_t> shardOf(const Manifest& manifest, std::size_t part, std::size_t parts);
/// These, by their ids or numbers from 1, each once, in the manifest's order. Throws UsageError,
/// naming what they are `of` and ending with `hint`, for one that is neither.
std::vector<std::size_t> stripsCalled(std::span<const std::string> names, const Manifest& manifest,
                                      const std::string& of, const std::string& hint = "");

}  // namespace agricolmap::batch
