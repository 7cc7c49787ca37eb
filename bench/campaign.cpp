// agricolmap_campaign: how often and how well pairs of unseen seeds are registered.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <vector>

#include "../apps/agricolmap/exit_code.hpp"
#include "agricolmap/config/text.hpp"
#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/pipeline/registration.hpp"
#include "campaign_cases.hpp"
#include "campaign_summary.hpp"
#include "campaign_table.hpp"
#include "pair_maker.hpp"
#include "register_pair.hpp"
#include "revision.hpp"

namespace agricolmap::campaign {
namespace {

struct Arguments {
  std::string output;
  std::string suite = "paper";
  std::vector<std::string> cases;
  std::vector<std::string> presets = {"default", "paper"};
  int pairs = 60;
  int paper_pairs = -1;
  int first_seed = 5001;
  int threads = 0;
  double time_limit = 0.0;
  std::string shared = "../shared";
  bool uniform = false;
  bool summary = false;
  bool list = false;
};

/// FNV-1a, to tell options apart in one line.
std::uint64_t hashText(std::string_view text, std::uint64_t hash = 0xCBF29CE484222325ULL) {
  for (const char c : text) {
    hash = (hash ^ static_cast<std::uint8_t>(c)) * 0x100000001B3ULL;
  }
  return hash;
}

/// What makes rows comparable: the code, the pairs and the options.
std::string identityOf(const std::vector<CampaignCase>& cases, bool uniform) {
  std::uint64_t hash = hashText("");
  for (const CampaignCase& one : cases) {
    hash = hashText(one.text(), hash);
  }
  for (const std::string& name : pipeline::presetNames()) {
    pipeline::RegistrationOptions options = pipeline::preset(name);
    hash = hashText(name + config::dumpYaml(optionTable(options)), hash);
  }
  return fmt::format("agricolmap_campaign {}, source {}, options {:016x}, guess errors {}",
                     AGRICOLMAP_VERSION, kRevision, hash, uniform ? "uniform" : "full size");
}

/// One pair to make and the presets to register it with.
struct Job {
  const CampaignCase* chosen;
  int seed;
  std::vector<std::string> presets;
};

/// Puts pairs of one drone's view together, views in the order of their first pair.
void groupByFlight(std::vector<Job>& jobs) {
  std::map<std::string, std::size_t> order;
  std::vector<std::pair<std::size_t, Job>> keyed;
  for (Job& job : jobs) {
    const auto at = order.emplace(job.chosen->flightText(job.seed), order.size()).first;
    keyed.emplace_back(at->second, std::move(job));
  }
  std::stable_sort(keyed.begin(), keyed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < jobs.size(); ++i) jobs[i] = std::move(keyed[i].second);
}

/// The presets that still have to register the `i`th pair of a case.
Job jobFor(const CampaignCase& chosen, int i, const Arguments& arguments, const PairTable& table) {
  Job job{&chosen, arguments.first_seed + i, {}};
  if (chosen.max_pairs > 0 && i >= chosen.max_pairs) return job;
  for (const std::string& name : arguments.presets) {
    const int limit = name.starts_with("paper") ? arguments.paper_pairs : arguments.pairs;
    if (i < limit && !table.has(chosen.name, job.seed, name) && canRegister(name, chosen)) {
      job.presets.push_back(name);
    }
  }
  return job;
}

/// What is left to do, field by field, so that an interrupted campaign has all cases.
std::vector<Job> plan(const std::vector<const CampaignCase*>& cases, const Arguments& arguments,
                      const PairTable& table) {
  int together = 1;
  for (const CampaignCase* chosen : cases) together = std::max(together, chosen->strips_per_field);
  std::vector<Job> jobs;
  std::vector<Job> round;
  const int pairs = std::max(arguments.pairs, arguments.paper_pairs);
  for (int i = 0; i < pairs;) {
    const int block = (arguments.first_seed + i) / together;
    int end = i;
    while (end < pairs && (arguments.first_seed + end) / together == block) ++end;
    round.clear();
    for (const CampaignCase* chosen : cases) {
      for (int k = i; k < end; ++k) {
        Job job = jobFor(*chosen, k, arguments, table);
        if (!job.presets.empty()) round.push_back(std::move(job));
      }
    }
    if (together > 1) groupByFlight(round);
    std::move(round.begin(), round.end(), std::back_inserter(jobs));
    i = end;
  }
  return jobs;
}

/// Says on stderr how far it is: in place on a terminal, else a line every half minute.
class Progress {
 public:
  Progress(const std::vector<Job>& jobs, const PairTable& table) : table_(&table) {
    for (const Job& job : jobs) {
      ++left_[""];
      for (const std::string& name : job.presets) ++left_[name];
    }
  }
  ~Progress() {
    if (terminal_) fmt::print(stderr, "\r\033[K");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void step(const Job& job) {
    const double now = watch_.seconds();
    if (!terminal_ && last_ >= 0.0 && now - last_ < 30.0) return;
    last_ = now;
    const std::string text = fmt::format("{} pairs left, {}; now {} seed {}", left_[""], timeLeft(),
                                         job.chosen->name, job.seed);
    fmt::print(stderr, "{}{}{}", terminal_ ? "\r\033[K" : "", text, terminal_ ? "" : "\n");
  }
  void done(const Job& job) {
    --left_[""];
    for (const std::string& name : job.presets) --left_[name];
  }

 private:
  /// From the mean times of all rows so far, those of earlier runs included.
  std::string timeLeft() {
    std::map<std::string, std::pair<double, int>> sums;
    for (const PairRow& row : table_->rows()) {
      sums[""].first += row.simulate_s;
      ++sums[""].second;
      sums[row.preset].first += row.total_s;
      ++sums[row.preset].second;
    }
    double seconds = 0.0;
    for (const auto& [name, count] : left_) {
      if (count == 0) continue;
      const auto sum = sums.find(name);
      if (sum == sums.end()) return "time left unknown yet";
      seconds += count * sum->second.first / sum->second.second;
    }
    return seconds < 5400.0 ? fmt::format("{:.0f} min", seconds / 60.0)
                            : fmt::format("{:.1f} h", seconds / 3600.0);
  }

  const PairTable* table_;
  std::map<std::string, int> left_;  ///< pairs under "", registrations under their presets
  Stopwatch watch_;
  double last_ = -1.0;
  bool terminal_ = ::isatty(STDERR_FILENO) != 0;
};

void writeSummary(const Arguments& arguments, const std::vector<CampaignCase>& cases,
                  const std::vector<PairRow>& rows, const std::string& identity) {
  std::vector<std::string> names;
  std::map<std::string, Target> targets;
  for (const CampaignCase& one : cases) {
    names.push_back(one.name);
    targets[one.name] = one.target;
  }
  const std::vector<SummaryLine> lines = summarise(rows, names, targets);
  const std::string markdown = summaryMarkdown(lines, identity);
  const std::filesystem::path folder = arguments.output;
  for (const auto& [name, text] : {std::pair<const char*, std::string>{"summary.md", markdown},
                                   {"summary.csv", summaryCsv(lines)}}) {
    io::StagedFile file(folder / name, true);
    io::writeText(file.path(), text);
    file.commit();
  }
  fmt::print("{}", markdown);
}

std::vector<const CampaignCase*> chooseCases(const Arguments& arguments,
                                             const std::vector<CampaignCase>& all,
                                             const PairMaker& maker) {
  std::vector<const CampaignCase*> chosen;
  std::vector<std::string> names;
  for (const CampaignCase& one : all) names.push_back(one.name);
  for (const std::string& name : arguments.cases.empty() ? names : arguments.cases) {
    const auto at = std::find(names.begin(), names.end(), name);
    if (at == names.end()) {
      throw UsageError(
          fmt::format("unknown case '{}'; there are: {}", name, fmt::join(names, ", ")));
    }
    const CampaignCase& one = all[static_cast<std::size_t>(at - names.begin())];
    std::string reason = maker.unavailable(one.source);
    if (one.scale_unknown && !knowsScaleUnknown()) {
      reason = "the registration cannot be told that the scale is unknown";
    }
    if (reason.empty()) {
      chosen.push_back(&one);
    } else {
      fmt::print(stderr, "skipped {}: {}\n", name, reason);
    }
  }
  return chosen;
}

/// True when nothing is left, false at the time limit.
bool work(const Arguments& arguments, const std::vector<Job>& jobs, PairMaker& maker,
          PairTable& table) {
  const Stopwatch watch;
  Progress progress(jobs, table);
  for (const Job& job : jobs) {
    if (arguments.time_limit > 0.0 && watch.seconds() > arguments.time_limit) return false;
    progress.step(job);
    const Stopwatch making;
    const CampaignPair pair = maker.make(*job.chosen, job.seed);
    const double simulate_s = making.seconds();
    for (const std::string& name : job.presets) {
      PairRow row = registerPair(pair, name, *job.chosen);
      row.case_name = job.chosen->name;
      row.seed = job.seed;
      row.field = job.chosen->fieldSeed(job.seed);
      row.threads = static_cast<int>(
          tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
      row.simulate_s = simulate_s;
      table.append(row);
    }
    progress.done(job);
  }
  return true;
}

void measure(const Arguments& arguments, const std::vector<CampaignCase>& all,
             const std::string& identity) {
  PairMaker maker(arguments.shared);
  const std::vector<const CampaignCase*> cases = chooseCases(arguments, all, maker);
  for (const std::string& name : arguments.presets) variant(name, {});  // throws for unknown ones
  std::error_code error;
  std::filesystem::create_directories(arguments.output, error);
  if (error) {
    throw OutputError(fmt::format("{}: cannot be made: {}", arguments.output, error.message()));
  }
  PairTable table(std::filesystem::path(arguments.output) / "pairs.csv", identity);
  const std::vector<Job> jobs = plan(cases, arguments, table);
  const bool complete = work(arguments, jobs, maker, table);
  writeSummary(arguments, all, table.rows(), identity);
  if (!complete) {
    fmt::print(stderr, "stopped at the time limit; the same command goes on from here\n");
  }
}

void addFlags(CLI::App& app, Arguments& arguments) {
  app.add_option("-o,--output", arguments.output, "Folder for pairs.csv and the summary");
  app.add_option("--suite", arguments.suite,
                 fmt::format("Suite of cases: {} [paper]", fmt::join(suiteNames(), ", ")));
  app.add_option("--cases", arguments.cases, "Names of cases [all of the suite]")->delimiter(',');
  app.add_option("--presets", arguments.presets,
                 "Presets, each with options to change: NAME or NAME:KEY=VALUE:… [default,paper]")
      ->delimiter(',');
  app.add_option("--pairs", arguments.pairs, "Pairs per case [60]")->check(CLI::Range(1, 100000));
  app.add_option("--paper-pairs", arguments.paper_pairs,
                 "Pairs per case for the presets 'paper' [as --pairs]")
      ->check(CLI::Range(0, 100000));
  app.add_option("--first-seed", arguments.first_seed, "Seed of the first pair [5001]");
  app.add_option("--shared", arguments.shared, "Folder with the real data [../shared]");
  app.add_option("--time-limit", arguments.time_limit, "Start no pair after this time [s]");
  app.add_option("--threads", arguments.threads, "Number of threads, 0: all cores [0]")
      ->check(CLI::Range(0, 1024));
  app.add_flag("--uniform", arguments.uniform,
               "Errors of the initial guess uniform up to the case's, not always as large");
  app.add_flag("--summary", arguments.summary, "Only summarise the rows that exist");
  app.add_flag("--list", arguments.list, "List the suite's cases and stop");
  app.footer("An interrupted campaign goes on where it stopped when called again.");
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Measures success and accuracy of the registration on pairs with known truth."};
  app.name("agricolmap_campaign");
  addFlags(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }
  if (arguments.paper_pairs < 0) arguments.paper_pairs = arguments.pairs;
  const std::vector<CampaignCase> cases = suiteCases(arguments.suite, arguments.uniform);
  if (arguments.list) {
    for (const CampaignCase& one : cases) fmt::print("{}\n", one.name);
    return 0;
  }
  if (arguments.output.empty()) throw UsageError("needs --output DIR; see --help");
  installInterruptHandler();
  const ThreadLimit limit(arguments.threads);
  if (arguments.summary) {
    std::string identity;
    const std::vector<PairRow> rows =
        readPairs(std::filesystem::path(arguments.output) / "pairs.csv", identity);
    writeSummary(arguments, cases, rows, identity);
  } else {
    measure(arguments, cases, identityOf(cases, arguments.uniform));
  }
  return 0;
}

}  // namespace
}  // namespace agricolmap::campaign

int main(int argc, char** argv) {
  using agricolmap::ExitCode;
  try {
    return agricolmap::campaign::run(argc, argv);
  } catch (const agricolmap::Interrupted&) {
    fmt::print(stderr, "agricolmap_campaign: interrupted; the same command goes on from here\n");
    return static_cast<int>(ExitCode::kInterrupted);
  } catch (const agricolmap::Error& error) {
    fmt::print(stderr, "agricolmap_campaign: {}\n", error.what());
    return static_cast<int>(agricolmap::exitCodeOf(error.kind()));
  } catch (const std::exception& error) {
    fmt::print(stderr, "agricolmap_campaign: {}\n", error.what());
    return static_cast<int>(ExitCode::kInternal);
  }
}
