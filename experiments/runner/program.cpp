// agricolmap_experiments: what methods come to on pairs with known truth.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "experiments/pairs/published.hpp"
#include "experiments/runner/campaign.hpp"
#include "revision.hpp"
#include "support/run_main.hpp"
#include "support/signal_stop.hpp"

namespace agricolmap::experiments {
namespace {

struct Arguments {
  std::string output;
  std::vector<std::string> suites = {"paper"};
  std::vector<std::string> cases = {};    ///< patterns; empty: all
  std::vector<std::string> methods = {};  ///< empty: of the suites
  std::vector<std::filesystem::path> published = {};
  std::string settings = "final";
  int pairs = 0;
  int first_seed = -1;
  bool uniform = false;
  bool quick = false;
  double stop_after = 0.0;
  int threads = 0;
  std::string shared = "../shared";
};

bool matchesAny(const std::string& name, const std::vector<std::string>& patterns) {
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0;
  });
}

/// Every pattern must name a case.
void checkPatterns(const std::vector<std::string>& patterns, const std::vector<Suite>& suites) {
  for (const std::string& pattern : patterns) {
    const bool known = std::any_of(suites.begin(), suites.end(), [&](const Suite& suite) {
      return std::any_of(suite.cases.begin(), suite.cases.end(),
                         [&](const Case& one) { return matchesAny(one.name, {pattern}); });
    });
    if (known) continue;
    throw UsageError(fmt::format(
        "no case is called '{}'; `agricolmap_experiments list cases --suite {}` lists them",
        pattern, suites.front().name));
  }
}

/// The suites with all their cases.
std::vector<Suite> suitesOf(const Arguments& arguments) {
  const std::vector<Case> published = publishedCases(arguments.published);
  std::vector<Suite> suites;
  for (const std::string& name : arguments.suites) {
    Suite suite = makeSuite(name, {.settings = parseSettings(arguments.settings),
                                   .uniform = arguments.uniform,
                                   .quick = arguments.quick});
    if (!published.empty() && suite.curves.empty()) {
      throw UsageError(fmt::format(
          "--published: the suite '{}' has no guesses for it; take translation, heading, joint, "
          "accuracy or inliers",
          name));
    }
    if (arguments.uniform && !suite.curves.empty()) {
      throw UsageError(
          fmt::format("--uniform: the suite '{}' has the errors of its guesses itself", name));
    }
    // Who asks for real pairs gets others only by name.
    if (!published.empty() && arguments.cases.empty()) suite.cases.clear();
    suite.cases.insert(suite.cases.end(), published.begin(), published.end());
    if (arguments.pairs > 0) suite.pairs = arguments.pairs;
    if (arguments.first_seed >= 0) suite.first_seed = arguments.first_seed;
    suites.push_back(std::move(suite));
  }
  checkPatterns(arguments.cases, suites);
  return suites;
}

/// Leaves the cases that are asked for and can be had. Makes published pairs once: what is wrong
/// with them is said now, not after hours of others.
void chooseCases(const Arguments& arguments, PairMaker& maker, std::vector<Suite>& suites) {
  std::vector<std::string> skipped;
  std::vector<std::string> tried;
  std::size_t left = 0;
  for (Suite& suite : suites) {
    std::erase_if(suite.cases, [&](const Case& one) {
      if (!arguments.cases.empty() && !one.published && !matchesAny(one.name, arguments.cases)) {
        return true;
      }
      const std::string reason = maker.unavailable(one);
      if (!reason.empty() && !matchesAny(one.name, skipped)) {
        fmt::print(stderr, "skipped {}: {}\n", one.name, reason);
        skipped.push_back(one.name);
      }
      if (reason.empty() && one.published && !matchesAny(one.name, tried)) {
        maker.make(one, suite.first_seed);
        tried.push_back(one.name);
      }
      return !reason.empty();
    });
    left += suite.cases.size();
  }
  if (left == 0) throw InputError("no case is left to run");
}

std::vector<Method> methodsOf(const Arguments& arguments, const std::vector<Suite>& suites) {
  std::vector<std::string> names = arguments.methods;
  // With errors of its own a suite compares all methods, else the presets.
  const bool compares = !suites.front().curves.empty();
  if (names.empty())
    names = compares ? methodNames() : std::vector<std::string>{"default", "paper"};
  std::vector<Method> methods;
  for (const std::string& name : names) methods.push_back(makeMethod(name));
  return methods;
}

void runAll(const Arguments& arguments) {
  PairMaker maker(arguments.shared);
  CampaignScope scope{.suites = suitesOf(arguments), .source = kRevision};
  scope.methods = methodsOf(arguments, scope.suites);
  const ThreadLimit limit(arguments.threads);
  chooseCases(arguments, maker, scope.suites);
  std::error_code error;
  std::filesystem::create_directories(arguments.output, error);
  if (error) {
    throw OutputError(fmt::format("{}: cannot be made: {}", arguments.output, error.message()));
  }
  RowTable table(std::filesystem::path(arguments.output) / "rows.csv", scope.source);
  const std::size_t before = table.rows().size();
  const bool complete = runCampaign(scope, arguments.stop_after, maker, table);
  fmt::print("{}: {} rows, {} of them new{}\n", table.path().string(), table.rows().size(),
             table.rows().size() - before,
             complete ? "" : "; stopped early, the same command goes on from here");
}

void list(const std::string& what, const Arguments& arguments) {
  if (what == "methods") {
    for (const std::string& name : methodNames()) {
      fmt::print("{:<32} {}\n", name, makeMethod(name).about);
    }
  } else if (what == "suites") {
    for (const std::string& name : suiteNames()) {
      std::vector<std::string> settings;
      for (const Settings one : settingsOf(name)) settings.push_back(toString(one));
      fmt::print("{:<16} {}\n", name, fmt::join(settings, ", "));
    }
  } else {
    for (const Suite& suite : suitesOf(arguments)) {
      for (const Case& one : suite.cases) fmt::print("{}\n", one.name);
    }
  }
}

void addSuiteFlags(CLI::App& verb, Arguments& arguments) {
  verb.add_option("--suite", arguments.suites,
                  fmt::format("{} [paper]", fmt::join(suiteNames(), ", ")))
      ->delimiter(',');
  verb.add_option(
      "--settings", arguments.settings,
      "How pairs may differ: develop, calibrate or final. Improve methods on the first,\n"
      "fit the verdict to the second, report the third [final]");
  verb.add_option(
          "--published", arguments.published,
          "Folder of real pairs as in docs/published-data.md, once or more; without --case\n"
          "nothing else is run")
      ->allow_extra_args(false);
  verb.add_flag("--quick", arguments.quick, "Small fields, short strips, few guesses: minutes");
}

void addRunFlags(CLI::App& verb, Arguments& arguments) {
  verb.add_option("-o,--output", arguments.output, "Folder for rows.csv")->required();
  addSuiteFlags(verb, arguments);
  verb.add_option("--case", arguments.cases, "Cases, with * for any text [all]")->delimiter(',');
  verb.add_option("--method", arguments.methods,
                  "Methods; a preset takes options: NAME:KEY=VALUE:... [default and paper; where\n"
                  "methods are compared, all]")
      ->delimiter(',');
  verb.add_option("--pairs", arguments.pairs, "Pairs, that is seeds, per case [of the suite]")
      ->check(CLI::Range(1, 100000));
  verb.add_option("--first-seed", arguments.first_seed, "Seed of the first pair [of the suite]")
      ->check(CLI::Range(0, 1000000000));
  verb.add_flag("--uniform", arguments.uniform,
                "Errors of the cases' own guesses from zero to their limits, not always as large");
  verb.add_option("--threads", arguments.threads, "Threads of a run, 0: all cores [0]")
      ->check(CLI::Range(0, 1024));
  verb.add_option("--stop-after", arguments.stop_after, "Begin no pair after this time [s]");
  verb.add_option("--shared", arguments.shared, "Folder with the real data [../shared]");
  verb.footer(
      "An interrupted run goes on where it stopped when called again. Seeds 31 and 51 to 53\n"
      "served to tune the peers.");
}

int run(int argc, char** argv) {
  Arguments arguments;
  std::string what;
  std::function<void()> action;
  CLI::App app{"What registration methods come to on pairs with known truth."};
  app.name("agricolmap_experiments");
  app.require_subcommand(1);
  CLI::App* lister = app.add_subcommand("list", "List suites, cases or methods");
  lister->add_option("WHAT", what, "suites, cases or methods")
      ->required()
      ->check(CLI::IsMember({"suites", "cases", "methods"}));
  addSuiteFlags(*lister, arguments);
  lister->callback([&] { action = [&] { list(what, arguments); }; });
  CLI::App* runner = app.add_subcommand("run", "Run methods on the pairs of suites");
  addRunFlags(*runner, arguments);
  runner->callback([&] { action = [&] { runAll(arguments); }; });
  spdlog::set_default_logger(spdlog::stderr_color_mt(app.get_name()));
  spdlog::set_pattern("%^%l%$: %v");
  return runMain(app, argc, argv, [&] {
    const SignalStop signals;
    const StopScope scope(signals.token());
    try {
      action();
    } catch (const Interrupted&) {
      throw Error(ErrorKind::kInterrupted, "interrupted; the same command goes on from here");
    }
  });
}

}  // namespace
}  // namespace agricolmap::experiments

int main(int argc, char** argv) { return agricolmap::experiments::run(argc, argv); }
