// agricolmap batch MANIFEST.yaml -o DIR
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "agricolmap/batch/run/batch_run.hpp"
#include "agricolmap/batch/summary.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/text/text.hpp"
#include "common.hpp"

namespace agricolmap {
namespace {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;

struct BatchArguments {
  std::string manifest;
  std::string output;
  std::vector<std::string> items;
  std::string shard;
  bool resume = false;
  bool list = false;
  int jobs = 0;
  double memory = 0.0;  ///< [GiB]; 0: a share of what there is
  bool no_pictures = false;
};

/// A whole number from 1 on, of the whole text; 0 where it is none.
std::size_t countOf(std::string_view text) {
  const std::optional<double> number = io::parseNumber(text);
  const bool whole = number && *number >= 1.0 && *number <= 1e9 && *number == std::floor(*number);
  return whole ? static_cast<std::size_t>(*number) : 0;
}

/// Strips of a part of the manifest: every n-th from the i-th on.
std::vector<std::size_t> shardOf(const std::string& text, const batch::Manifest& manifest) {
  const std::size_t slash = text.find('/');
  const std::size_t part = countOf(std::string_view(text).substr(0, slash));
  const std::size_t parts =
      slash == std::string::npos ? 0 : countOf(std::string_view(text).substr(slash + 1));
  if (part == 0 || parts == 0 || part > parts) {
    throw UsageError(fmt::format("--shard {}: must be i/n, such as 3/8: i from 1 to n", text));
  }
  return batch::shardOf(manifest, part, parts);
}

std::vector<std::size_t> chosenStrips(const BatchArguments& arguments,
                                      const batch::Manifest& manifest) {
  if (!arguments.items.empty() && !arguments.shard.empty()) {
    throw UsageError("--item and --shard do not go together");
  }
  if (!arguments.shard.empty()) return shardOf(arguments.shard, manifest);
  if (arguments.items.empty()) return batch::allStrips(manifest);
  return batch::stripsCalled(arguments.items, manifest, "--item", "; --list names them");
}

batch::RunOptions optionsOf(const BatchArguments& arguments, const Globals& globals) {
  batch::RunOptions options;
  options.output = arguments.output;
  options.resume = arguments.resume;
  options.overwrite = globals.overwrite;
  options.pictures = !arguments.no_pictures;
  options.jobs = static_cast<std::size_t>(std::max(0, arguments.jobs));
  options.memory = arguments.memory * kGiB;
  options.threads = globals.threads;
  options.version = AGRICOLMAP_VERSION;
  options.stop = globals.stop;
  return options;
}

/// What is said while it works.
class Talk {
 public:
  Talk(const batch::Manifest& manifest, const Globals& globals)
      : globals_(globals), progress_(globals) {
    constexpr std::size_t kWidestId = 40;
    for (const batch::Strip& strip : manifest.strips) {
      id_width_ = std::clamp(strip.id.size(), id_width_, kWidestId);
    }
  }
  /// For as long as this lives.
  batch::Listener listener() {
    batch::Listener listener;
    listener.on_kept = [this](std::size_t kept, std::size_t of) {
      if (!globals_.quiet) fmt::print("{} of {} strips are done already\n", kept, of);
    };
    listener.on_map = [this](const std::string& map) { progress_.step("map " + map); };
    listener.on_points = progress_.ofPasses();
    listener.on_map_warnings = printWarnings;
    listener.on_detail = [](const std::string& strip, const std::string& text) {
      spdlog::debug("{}: {}", strip, text);
    };
    listener.on_strip = [this](const batch::Record& record, const batch::Progress& progress) {
      strip(record, progress);
    };
    return listener;
  }

 private:
  void strip(const batch::Record& record, const batch::Progress& progress) {
    if (!globals_.quiet) {
      progress_.clear();
      fmt::print("{}\n", batch::lineOf(record, id_width_));
      std::fflush(stdout);
    }
    const double each = progress.seconds / static_cast<double>(progress.worked);
    const auto left = static_cast<double>(progress.todo - progress.worked);
    progress_.step(fmt::format("{} of {} strips, {:.1f} s each, {:.0f} min left", progress.worked,
                               progress.todo, each, each * left / 60.0));
  }

  const Globals& globals_;
  Progress progress_;
  std::size_t id_width_ = 0;
};

ExitCode exitCodeFor(const std::vector<const batch::StripOutcome*>& outcomes) {
  batch::Counts counts;
  for (const batch::StripOutcome* outcome : outcomes) counts.add(*outcome->record);
  if (counts.failed > 0) {
    return outcomes.size() == 1 ? exitCodeOf(outcomes.front()->error) : ExitCode::kSomeFailed;
  }
  if (counts.rejected > 0) return ExitCode::kRejected;
  return counts.ambiguous > 0 ? ExitCode::kAmbiguous : ExitCode::kOk;
}

void sayInterrupted(const batch::Batch& batch, std::size_t of) {
  const auto done =
      std::count_if(batch.outcomes().begin(), batch.outcomes().end(),
                    [](const batch::StripOutcome& one) { return one.record.has_value(); });
  spdlog::warn(
      "interrupted; {} of {} strips are done: the same command with --resume does the rest", done,
      of);
}

ExitCode runBatch(const BatchArguments& arguments, const Globals& globals) {
  if (arguments.manifest.empty() || (arguments.output.empty() && !arguments.list)) {
    throw UsageError("batch needs MANIFEST.yaml and -o DIR; see agricolmap batch --help");
  }
  batch::Manifest manifest = batch::readManifest(arguments.manifest);
  const std::vector<std::size_t> chosen = chosenStrips(arguments, manifest);
  if (arguments.list) {
    for (const std::size_t i : chosen) fmt::print("{}\n", manifest.strips[i].id);
    return ExitCode::kOk;
  }
  for (batch::Strip& strip : manifest.strips) {
    if (globals.seed_given) strip.options.seed = globals.seed;
    if (arguments.no_pictures) strip.settings.pictures = false;
    requirePictures(!strip.settings.pictures);
  }
  requirePictures(arguments.no_pictures);
  const batch::RunOptions options = optionsOf(arguments, globals);
  const bool whole = arguments.items.empty() && arguments.shard.empty();
  const Stopwatch watch;
  Talk talk(manifest, globals);
  const batch::Listener listener = talk.listener();
  batch::Batch batch(manifest, options, listener);
  try {
    batch.run(chosen, whole && options.pictures);
    throwIfInterrupted();
  } catch (const Interrupted&) {
    sayInterrupted(batch, chosen.size());
    return ExitCode::kInterrupted;
  }
  if (whole) batch.writeSummary(watch.seconds());
  std::vector<const batch::StripOutcome*> outcomes;
  batch::Counts counts;
  for (const std::size_t i : chosen) {
    outcomes.push_back(&batch.outcomes()[i]);
    counts.add(*outcomes.back()->record);
  }
  if (!globals.quiet) {
    fmt::print("{} strip{}: {}; results in {}\n", counts.all(), counts.all() == 1 ? "" : "s",
               toText(counts), arguments.output);
  }
  return exitCodeFor(outcomes);
}

}  // namespace

CommandSlot addBatchCommand(CLI::App& app, const Globals& globals) {
  auto arguments = std::make_shared<BatchArguments>();
  CLI::App* command = app.add_subcommand(
      "batch", "Register many strips into one or several maps, as MANIFEST.yaml lists them");
  command->add_option("MANIFEST", arguments->manifest, "YAML: see docs/batch.md");
  command->add_option(
      "-o,--output", arguments->output,
      "Folder for the results: a folder for each strip, and summary.csv, .json, .html, .png");
  command->add_flag("--resume", arguments->resume,
                    "Keep strips that are done and of which nothing has changed");
  command->add_option("--item", arguments->items,
                      "Only this strip, by its id or number; repeatable");
  command->add_option("--shard", arguments->shard,
                      "Only part i of n: i/n with i from 1. A part writes no summary");
  command->add_option("-j,--jobs", arguments->jobs, "Strips at once, at most [as many as threads]")
      ->check(CLI::Range(1, 1024));
  command
      ->add_option("--memory", arguments->memory,
                   "GiB that all strips at once may take [4/5 of what is available]")
      ->check(CLI::PositiveNumber);
  command->add_flag("--no-pictures", arguments->no_pictures,
                    "Write no PNG pictures, and reports of words and numbers only");
  command->add_flag("--list", arguments->list, "Print the ids of the strips and stop");
  command->footer(
      "Exit codes: 0 all accepted; 12 some strips failed; else 10 some rejected; else 11 some "
      "ambiguous.\nOf a single strip, that of register.");
  return {command, [arguments, &globals] { return runBatch(*arguments, globals); }};
}

}  // namespace agricolmap
