// What all commands share: global flags, progress, reading a cloud with its place in the world.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "agricolmap/core/cloud.hpp"
#include "agricolmap/core/stopwatch.hpp"
#include "agricolmap/io/cloud/cloud_format.hpp"
#include "support/exit_code.hpp"

namespace agricolmap {

/// Flags that every command takes.
struct Globals {
  int threads = 0;
  int seed = 1;
  bool seed_given = false;
  int verbose = 0;
  bool quiet = false;
  bool overwrite = false;
  std::stop_token stop;  ///< asked to stop by SIGINT and SIGTERM
  std::vector<std::string> command_line;
};

/// Registers one verb; the returned code is the program's.
using Command = std::function<ExitCode()>;
struct CommandSlot {
  CLI::App* app;
  Command run;
};
CommandSlot addBatchCommand(CLI::App& app, const Globals& globals);
CommandSlot addRegisterCommand(CLI::App& app, const Globals& globals);
CommandSlot addSimulateCommand(CLI::App& app, const Globals& globals);
CommandSlot addEvaluateCommand(CLI::App& app, const Globals& globals);
CommandSlot addControlPointsCommand(CLI::App& app, const Globals& globals);
CommandSlot addApplyCommand(CLI::App& app, const Globals& globals);
CommandSlot addFuseCommand(CLI::App& app, const Globals& globals);
CommandSlot addConvertCommand(CLI::App& app, const Globals& globals);
CommandSlot addImportCommand(CLI::App& app, const Globals& globals);
CommandSlot addDiffCommand(CLI::App& app, const Globals& globals);
CommandSlot addFactsCommand(CLI::App& app, const Globals& globals);
CommandSlot addPrescribeCommand(CLI::App& app, const Globals& globals);
CommandSlot addInfoCommand(CLI::App& app, const Globals& globals);
CommandSlot addDocumentCommand(CLI::App& app, const Globals& globals);
CommandSlot addManualsCommand(CLI::App& app, const Globals& globals);
CommandSlot addCompletionCommand(CLI::App& app, const Globals& globals);

/// How a pass over a cloud's points goes on: "30.0 of 100.0 million points, 25.0 million/s, 3 s
/// left".
/// `seconds`: since it began.
std::string passText(std::size_t seen, std::size_t of, double seconds);

/// One line on stderr that names the current step; silent unless stderr is a terminal.
class Progress {
 public:
  explicit Progress(const Globals& globals);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void step(std::string_view what);
  /// Of the step's present pass over a cloud, `seen` of `of` points are done. Passes that are short
  /// are not worth a word.
  void points(std::size_t seen, std::size_t of);
  /// The same for those who call back, for as long as this lives.
  std::function<void(std::size_t, std::size_t)> ofPasses() {
    return [this](std::size_t seen, std::size_t of) { points(seen, of); };
  }
  /// Takes the line away, for something else to be said.
  void clear() const { show(""); }

 private:
  void show(std::string_view text) const;
  bool active_;
  std::string step_;
  std::size_t seen_ = 0;
  Stopwatch pass_;
  double shown_ = 0.0;  ///< when, in the pass [s]
};

/// The flags that are this remedy, as ` (--overwrite)`; empty where there are none.
std::string flagsFor(Remedy remedy);
/// Throws UsageError when pictures are asked for that this build cannot draw.
void requirePictures(bool no_pictures);
/// The way from a page in `folder` to `page`, as a page names it; empty where `page` is or there is
/// none.
std::string wayTo(const std::filesystem::path& page, const std::filesystem::path& folder);
/// To stderr, one line each, unless --quiet.
void printWarnings(const std::vector<std::string>& warnings);
/// Warns where a file of this format has no place for the coordinate system.
void warnOfLostCrs(const std::string& file, io::CloudFormat format, const Crs& crs);

}  // namespace agricolmap
