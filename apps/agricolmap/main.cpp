// The command line: verbs, global flags, and errors as exit codes.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <new>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/core/processor.hpp"
#include "agricolmap/io/raster/raster_file.hpp"
#include "common.hpp"
#include "option_flags.hpp"
#include "program_revision.hpp"
#include "support/signal_stop.hpp"

namespace agricolmap {
namespace {

constexpr const char* kFooter =
    "Exit codes: 0 done, registration accepted; 1 internal error; 2 bad usage; 3 bad input;\n"
    "4 output cannot be written; 10 registration rejected; 11 ambiguous; 12 some strips of a "
    "batch\n"
    "failed; 130 interrupted.\n"
    "Lengths are metres, maps are LAS, LAZ, PLY, PCD, text or ORTHO.tif,DSM.tif, transforms map "
    "MOVING to FIXED file coordinates.";

/// A map of a thousand strips has them all open, and a terminal allows 1024 files unless it is
/// asked.
void allowManyFiles() {
  rlimit files{};
  if (::getrlimit(RLIMIT_NOFILE, &files) != 0 || files.rlim_cur >= files.rlim_max) return;
  files.rlim_cur = files.rlim_max;
  std::ignore = ::setrlimit(RLIMIT_NOFILE, &files);
}

void setUpLogging(const Globals& globals) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("agricolmap"));
  spdlog::set_pattern("%^%l%$: %v");
  spdlog::set_level(globals.quiet         ? spdlog::level::err
                    : globals.verbose > 0 ? spdlog::level::debug
                                          : spdlog::level::info);
}

/// How many letters must be put in, left out or changed to make one word of the other.
std::size_t lettersApart(const std::string& one, const std::string& other) {
  std::vector<std::size_t> row(other.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < one.size(); ++i) {
    std::size_t above_left = std::exchange(row[0], i + 1);
    for (std::size_t k = 0; k < other.size(); ++k) {
      const std::size_t changed = above_left + (one[i] == other[k] ? 0 : 1);
      above_left = row[k + 1];
      row[k + 1] = std::min({changed, row[k] + 1, above_left + 1});
    }
  }
  return row.back();
}

/// What `verb` was given and does not know, with what may have been meant.
std::string describeUnknown(const CLI::App& app, const CLI::App& verb) {
  constexpr std::size_t kMistyped = 2;  // letters
  const std::vector<std::string> words = app.remaining(true);
  const auto flag = std::find_if(words.begin(), words.end(), [](const std::string& word) {
    return word.size() > 1 && word.starts_with("-");
  });
  const std::string see = fmt::format("see agricolmap {} --help", verb.get_name());
  if (flag == words.end()) {
    return fmt::format("'{}' is more than {} takes; {}", words.front(), verb.get_name(), see);
  }
  const std::string typed = flag->substr(0, flag->find('='));
  std::string meant;
  std::size_t least = kMistyped + 1;
  for (const CLI::App* taker : {&verb, &app}) {
    for (const CLI::Option* option : taker->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        const std::size_t apart = lettersApart(typed, "--" + name);
        if (apart < least) meant = name;
        least = std::min(least, apart);
      }
    }
  }
  return fmt::format("{} has no option '{}'; {}{}", verb.get_name(), typed,
                     meant.empty() ? "" : fmt::format("is --{} meant? ", meant), see);
}

/// Of a build from a clone, with the commit, and a plus where sources were changed since.
std::string versionText() {
  const std::string revision = kProgramRevision;
  return fmt::format("agricolmap {}{}", AGRICOLMAP_VERSION,
                     revision.empty() ? "" : " (" + revision + ")");
}

std::vector<CommandSlot> addCommands(CLI::App& app, const Globals& globals) {
  return {addRegisterCommand(app, globals), addSimulateCommand(app, globals),
          addEvaluateCommand(app, globals), addControlPointsCommand(app, globals),
          addBatchCommand(app, globals),    addConvertCommand(app, globals),
          addImportCommand(app, globals),   addApplyCommand(app, globals),
          addFuseCommand(app, globals),     addDiffCommand(app, globals),
          addFactsCommand(app, globals),    addPrescribeCommand(app, globals),
          addInfoCommand(app, globals),     addDocumentCommand(app, globals),
          addManualsCommand(app, globals),  addCompletionCommand(app, globals)};
}

ExitCode run(int argc, char** argv) {
  Globals globals;
  globals.command_line.assign(argv, argv + argc);
  CLI::App app{
      "AgriColMap lays a ground robot's 3D map of a crop field into a drone's, to the centimetre."};
  app.name("agricolmap");
  app.footer(kFooter);
  app.set_version_flag("--version", versionText());
  app.require_subcommand(1);
  app.fallthrough();
  app.add_option("--threads", globals.threads, "Number of threads, 0: all cores [0]")
      ->check(CLI::Range(0, 1024));
  const CLI::Option* seed = app.add_option("--seed", globals.seed, "Seed of everything random [1]");
  app.add_flag("-v,--verbose", globals.verbose, "Say more on stderr");
  app.add_flag("-q,--quiet", globals.quiet, "Say nothing but errors");
  app.add_flag("--overwrite", globals.overwrite, "Replace results that exist");
  const std::vector<CommandSlot> commands = addCommands(app, globals);
  try {
    // The parser takes them from the end.
    std::vector<std::string> words;
    for (int i = argc - 1; i > 0; --i) words.push_back(spelledWithDashes(argv[i]));
    app.parse(std::move(words));
  } catch (const CLI::RequiredError& error) {
    // CLI11 would only say that a verb is missing.
    const std::vector<std::string> words = app.remaining();
    if (words.empty() || words.front().starts_with("-")) {
      app.exit(error);
      return ExitCode::kUsage;
    }
    throw UsageError(fmt::format("there is no verb '{}'; see agricolmap --help", words.front()));
  } catch (const CLI::ExtrasError& error) {
    // CLI11 would say what is left over from behind.
    const std::vector<CLI::App*> verbs = app.get_subcommands();
    if (verbs.empty() || app.remaining(true).empty()) {
      app.exit(error);
      return ExitCode::kUsage;
    }
    throw UsageError(describeUnknown(app, *verbs.front()));
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  globals.seed_given = seed->count() > 0;
  setUpLogging(globals);
  requireProcessor();
  io::silenceGdal();
  const SignalStop signals;
  globals.stop = signals.token();
  const StopScope scope(globals.stop);
  const ThreadLimit limit(globals.threads);
  for (const CommandSlot& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  return ExitCode::kUsage;
}

/// What was said must have arrived: of a full disk nothing else tells.
void requireStdout() {
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  const std::string reason = flushed ? "" : fmt::format(": {}", std::strerror(errno));
  if (flushed && std::ferror(stdout) == 0 && std::cout) return;
  throw OutputError(fmt::format("standard output: cannot be written{}", reason));
}

}  // namespace
}  // namespace agricolmap

int main(int argc, char** argv) {
  using agricolmap::ExitCode;
  const auto fail = [](const char* what, ExitCode code, const std::string& flags = "") {
    fmt::print(stderr, "agricolmap: {}{}\n", what, flags);
    return static_cast<int>(code);
  };
  agricolmap::allowManyFiles();
  try {
    const ExitCode code = agricolmap::run(argc, argv);
    agricolmap::requireStdout();
    return static_cast<int>(code);
  } catch (const agricolmap::Error& error) {
    return fail(error.what(), agricolmap::exitCodeOf(error.kind()),
                agricolmap::flagsFor(error.remedy()));
  } catch (const std::bad_alloc&) {
    return fail("out of memory; crop the clouds or enlarge grid.cell", ExitCode::kInternal);
  } catch (const std::exception& error) {
    // Of fmt::print, on a full disk.
    if (std::ferror(stdout) != 0) {
      return fail(fmt::format("standard output: {}", error.what()).c_str(), ExitCode::kOutput);
    }
    return fail(error.what(), ExitCode::kInternal);
  }
}
