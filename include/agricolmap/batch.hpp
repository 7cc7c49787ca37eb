// Many strips registered in one go, each to a folder, as the command line's `batch` does.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "agricolmap/cloud.hpp"
#include "agricolmap/export.hpp"
#include "agricolmap/register.hpp"
#include "agricolmap/result.hpp"

namespace agricolmap {

/// What registerBatch is told beside the manifest.
struct BatchSettings {
  /// The manifest itself, instead of what stands in its file: YAML, or JSON.
  std::optional<std::string> text = std::nullopt;
  bool resume = false;                  ///< keep folders of strips of which nothing has changed
  bool overwrite = false;               ///< replace those that are there
  std::vector<std::string> items = {};  ///< these strips alone, by their ids or numbers from 1
  int shard = 0;  ///< every `shards`-th strip alone, from this one on, counted from 1; 0: all
  int shards = 0;
  int jobs = 0;               ///< strips at once, at most; 0: as many as threads
  double memory_bytes = 0.0;  ///< that all at once may take; 0: 4/5 of what is available
  bool pictures = true;       ///< else none, whatever the manifest says
};

/// What became of a strip.
struct BatchStrip {
  std::string id;
  std::string map;  ///< the id of its map
  /// Of its results; where it failed, of those of an earlier run, or not there.
  std::filesystem::path folder;
  std::optional<Registration::Status> status;  ///< nothing: it failed, see `message`
  double plane_probability = 0.0;              ///< that it is right in the plane to 5 cm
  std::optional<double> expected_rms_m;        ///< in the plane
  bool heights_measured = false;               ///< else limited
  std::optional<double> height_deviation_m;    ///< of the heights
  double seconds = 0.0;
  int date = 0;         ///< YYYYMMDD; 0: nobody said
  std::string message;  ///< why it is not accepted, in a line
  bool kept = false;    ///< was there already
  /// Corners around it from above, fixed file's coordinates [m].
  std::vector<Eigen::Vector2d> outline;
};

/// Hears of each strip that is done: of `todo` strips that are registered now it is number `done`.
/// Called by one thread at a time, not always the same. What it throws stops the batch and is
/// thrown by registerBatch.
using StripListener =
    std::function<void(const BatchStrip& strip, std::size_t done, std::size_t todo)>;

/// Component batch. Registers the strips of a manifest (docs/batch.md), each to the folder
/// `output`/ID, which appears whole or not at all; of all strips a summary. A strip that fails
/// stops no other, and leaves what an earlier run made of it. Returns those that were chosen, in
/// the manifest's order. Throws UsageError with all that is wrong in the manifest and for settings,
/// InputError, OutputError when results are there that are neither to be kept nor replaced,
/// Interrupted: what is done by then stays. Control::on_stage is not called.
AGRICOLMAP_EXPORT std::vector<BatchStrip> registerBatch(const std::filesystem::path& manifest,
                                                        const std::filesystem::path& output,
                                                        const BatchSettings& settings = {},
                                                        const Control& control = {},
                                                        const StripListener& on_strip = {});

}  // namespace agricolmap
