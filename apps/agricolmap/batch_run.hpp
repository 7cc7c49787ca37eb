// The strips of a batch, registered side by side: each to a folder that appears whole or not at
// all.
#pragma once

#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/batch/manifest.hpp"
#include "agricolmap/batch/picture/summary_picture.hpp"
#include "agricolmap/batch/record.hpp"
#include "common.hpp"
#include "pair_files.hpp"

namespace agricolmap {

/// How many threads there may be: as --threads says, else one for each core.
std::size_t threadsInForce();

/// Fixed clouds, decoded and sorted once for all who ask, from several threads.
class SharedFixed {
 public:
  /// Decoded now, the first time; what went wrong then is thrown to whoever asks again.
  std::shared_ptr<const LoadedFixed> get(const io::MapFiles& files, const io::CommonFrame& frame);
  std::function<void(std::size_t, std::size_t)> on_pass;

 private:
  struct Entry {
    std::shared_ptr<const LoadedFixed> fixed;
    std::exception_ptr error;
  };
  std::mutex mutex_;
  std::map<std::string, Entry> entries_;  ///< by files and frame
};

struct BatchOptions {
  std::filesystem::path output;
  bool resume = false;
  std::size_t jobs = 1;
  double memory = 0.0;  ///< [bytes]
  bool pictures = true;
};

/// What became of a strip.
struct StripOutcome {
  std::optional<batch::Record> record;  ///< nothing: not looked at, or interrupted
  ExitCode code = ExitCode::kOk;        ///< why there is no answer
  bool kept = false;                    ///< was there already
};

class Batch {
 public:
  Batch(const batch::Manifest& manifest, const BatchOptions& options, const Globals& globals);

  /// Registers these strips, map by map. Throws OutputError when one of them has results already
  /// that are neither to be kept nor replaced. `grounds`: whether maps are to be drawn.
  void run(const std::vector<std::size_t>& strips, bool grounds);

  const std::vector<StripOutcome>& outcomes() const { return outcomes_; }
  const std::vector<batch::MapGround>& grounds() const { return grounds_; }
  /// How many were registered now.
  std::size_t worked() const { return worked_; }

 private:
  std::filesystem::path folderOf(std::size_t strip) const;
  std::vector<std::size_t> keepFinished(const std::vector<std::size_t>& strips);
  void removeLeftovers(const std::vector<std::size_t>& strips) const;
  void runMap(const std::vector<std::size_t>& strips, SharedFixed& shared);
  std::shared_ptr<const LoadedFixed> prepare(const std::vector<std::size_t>& strips,
                                             SharedFixed& shared);
  void doStrip(std::size_t strip, SharedFixed& shared);
  batch::Record registered(std::size_t strip, SharedFixed& shared) const;
  void tell(std::size_t strip, batch::Record record, ExitCode code);

  const batch::Manifest& manifest_;
  const BatchOptions& options_;
  const Globals& globals_;
  Progress progress_;
  std::size_t id_width_ = 0;
  std::mutex mutex_;  ///< of what follows, while strips run
  std::vector<StripOutcome> outcomes_;
  std::vector<batch::MapGround> grounds_;
  std::size_t todo_ = 0;
  std::size_t worked_ = 0;
  Stopwatch watch_;
};

}  // namespace agricolmap
