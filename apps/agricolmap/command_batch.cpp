// agricolmap batch MANIFEST.yaml -o DIR
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "agricolmap/batch/memory.hpp"
#include "agricolmap/batch/picture/summary_page.hpp"
#include "agricolmap/batch/summary.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/text.hpp"
#include "batch_run.hpp"
#include "register_run.hpp"

namespace agricolmap {
namespace fs = std::filesystem;
namespace {

constexpr double kGiB = 1024.0 * 1024.0 * 1024.0;
constexpr double kShareOfMemory = 0.8;  ///< of what is available

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
std::vector<std::size_t> shardOf(const std::string& text, std::size_t strips) {
  const std::size_t slash = text.find('/');
  const std::size_t part = countOf(std::string_view(text).substr(0, slash));
  const std::size_t parts =
      slash == std::string::npos ? 0 : countOf(std::string_view(text).substr(slash + 1));
  if (part == 0 || parts == 0 || part > parts) {
    throw UsageError(fmt::format("--shard {}: must be i/n, such as 3/8: i from 1 to n", text));
  }
  std::vector<std::size_t> chosen;
  for (std::size_t i = part - 1; i < strips; i += parts) chosen.push_back(i);
  return chosen;
}

/// An id, or a number counted from 1.
std::size_t itemOf(const std::string& text, const batch::Manifest& manifest) {
  const auto found = std::find_if(manifest.strips.begin(), manifest.strips.end(),
                                  [&](const batch::Strip& strip) { return strip.id == text; });
  if (found != manifest.strips.end()) {
    return static_cast<std::size_t>(found - manifest.strips.begin());
  }
  const std::size_t number = countOf(text);
  if (number >= 1 && number <= manifest.strips.size()) return number - 1;
  throw UsageError(
      fmt::format("--item {}: is neither the id of a strip of {} nor a number from 1 "
                  "to {}; --list names them",
                  text, manifest.file.string(), manifest.strips.size()));
}

std::vector<std::size_t> chosenStrips(const BatchArguments& arguments,
                                      const batch::Manifest& manifest) {
  if (!arguments.items.empty() && !arguments.shard.empty()) {
    throw UsageError("--item and --shard do not go together");
  }
  if (!arguments.shard.empty()) return shardOf(arguments.shard, manifest.strips.size());
  std::vector<std::size_t> chosen;
  for (const std::string& item : arguments.items) chosen.push_back(itemOf(item, manifest));
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  if (!arguments.items.empty()) return chosen;
  chosen.resize(manifest.strips.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  return chosen;
}

BatchOptions optionsOf(const BatchArguments& arguments) {
  BatchOptions options;
  options.output = arguments.output;
  options.resume = arguments.resume;
  options.pictures = !arguments.no_pictures;
  options.jobs = arguments.jobs > 0 ? static_cast<std::size_t>(arguments.jobs) : threadsInForce();
  options.memory = arguments.memory > 0.0
                       ? arguments.memory * kGiB
                       : kShareOfMemory * batch::availableMemory() + batch::memoryInUse();
  return options;
}

void writeWhole(const fs::path& path, const std::string& text) {
  io::StagedFile file(path, true);
  io::writeText(file.path(), text);
  file.commit();
}

/// summary.csv, .json and .html, and the picture.
void writeSummary(const Batch& batch, const batch::Manifest& manifest, const fs::path& folder,
                  double seconds) {
  std::vector<batch::Record> records;
  for (const StripOutcome& outcome : batch.outcomes()) {
    if (outcome.record) records.push_back(*outcome.record);
  }
  writeWhole(folder / "summary.csv", batch::csvOf(records));
  writeWhole(folder / "summary.json", batch::jsonOf(records, manifest, seconds));
  writeWhole(folder / "summary.html", batch::summaryPage(records, manifest, seconds));
  if (batch.grounds().empty()) return;
  io::StagedFile picture(folder / "summary.png", true);
  batch::writeSummaryPicture(picture.path(), batch.grounds(), records);
  picture.commit();
}

ExitCode exitCodeFor(const std::vector<const StripOutcome*>& outcomes) {
  batch::Counts counts;
  for (const StripOutcome* outcome : outcomes) counts.add(*outcome->record);
  if (counts.failed > 0) {
    return outcomes.size() == 1 ? outcomes.front()->code : ExitCode::kSomeFailed;
  }
  if (counts.rejected > 0) return ExitCode::kRejected;
  return counts.ambiguous > 0 ? ExitCode::kAmbiguous : ExitCode::kOk;
}

void sayInterrupted(const Batch& batch, std::size_t of) {
  const auto done = std::count_if(batch.outcomes().begin(), batch.outcomes().end(),
                                  [](const StripOutcome& one) { return one.record.has_value(); });
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
  const BatchOptions options = optionsOf(arguments);
  const bool whole = arguments.items.empty() && arguments.shard.empty();
  const Stopwatch watch;
  Batch batch(manifest, options, globals);
  try {
    batch.run(chosen, whole && options.pictures);
    throwIfInterrupted();
  } catch (const Interrupted&) {
    sayInterrupted(batch, chosen.size());
    return ExitCode::kInterrupted;
  }
  if (whole) writeSummary(batch, manifest, options.output, watch.seconds());
  std::vector<const StripOutcome*> outcomes;
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
