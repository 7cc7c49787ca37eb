// agricolmap_compare: the paper's experiments with all methods.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>

#include "agricolmap/config/yaml.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/pipeline/options.hpp"
#include "page/comparison_page.hpp"
#include "page/statistics.hpp"
#include "page/summary.hpp"
#include "revision.hpp"
#include "runner/campaign.hpp"
#include "runner/child_process.hpp"
#include "runner/pair_provider.hpp"
#include "runner/published_sets.hpp"

namespace agricolmap::experiments {
namespace {

struct Arguments {
  std::string output;
  std::vector<std::string> experiments = experimentNames();
  std::vector<std::string> methods = {};  ///< empty: all
  std::vector<std::string> datasets = dataSetNames();
  std::vector<std::filesystem::path> published = {};  ///< folders
  int pairs = -1;
  int first_seed = 80001;
  double time_limit = -1.0;
  int jobs = 1;
  std::string shared = "../shared";
  std::string scratch;
  std::string docs;
  std::string settings;
  Views views = Views::kFinal;
  bool quick = false;
  bool page_only = false;
};

/// What makes rows comparable: the code, the fields, the real data and the limits.
std::string identityOf(const Arguments& arguments, const std::vector<DataSet>& chosen) {
  std::uint64_t hash = hashText("");
  for (const DataSet& set : allDataSets(arguments.views, arguments.quick))
    hash ^= hashText(set.pairs.text());
  for (const std::string& name : pipeline::presetNames()) {
    pipeline::RegistrationOptions options = pipeline::preset(name);
    hash ^= hashText(name + config::dumpYaml(optionTable(options)));
  }
  const std::string real = publishedText(chosen);
  return fmt::format(
      "agricolmap_compare {}, source {}, {} settings, options {:016x}, time limit {:g} s{}{}",
      AGRICOLMAP_VERSION, kRevision, toString(arguments.views), hash, arguments.time_limit,
      arguments.quick ? ", quick" : "",
      real.empty() ? "" : fmt::format(", real data {:016x}", hashText(real)));
}

/// agricolmap_method, which is built beside this program.
std::filesystem::path methodProgram() {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "agricolmap_method";
  if (!std::filesystem::exists(program)) {
    throw InputError(fmt::format("{} is missing; build it, too", program.string()));
  }
  return program;
}

/// The first words of what `agricolmap_method list` prints.
std::vector<std::string> methodNamesOf(const std::filesystem::path& program) {
  const std::filesystem::path listing = std::filesystem::temp_directory_path() /
                                        fmt::format("agricolmap_compare_{}.list", ::getpid());
  runChild({program.string(), "list"}, 30.0, listing);
  std::vector<std::string> names;
  std::ifstream file(listing);
  for (std::string line; std::getline(file, line);) {
    names.push_back(line.substr(0, line.find(' ')));
  }
  std::error_code ignored;
  std::filesystem::remove(listing, ignored);
  if (names.empty()) throw InputError(fmt::format("{}: lists no methods", program.string()));
  return names;
}

void checkMethods(const std::vector<std::string>& names, const std::vector<std::string>& all) {
  for (const std::string& name : names) {
    if (std::find(all.begin(), all.end(), name) == all.end()) {
      throw UsageError(
          fmt::format("unknown method '{}'; there are: {}", name, fmt::join(all, ", ")));
    }
  }
}

/// The data sets that are asked for and can be had. Throws InputError when none can, and for real
/// pairs that cannot be used: now, not after hours of others, whose rows a mended pair would not
/// belong to.
std::vector<DataSet> chosenDataSets(const Arguments& arguments) {
  std::vector<DataSet> asked = chooseDataSets(arguments.datasets, arguments.views, arguments.quick);
  for (DataSet& set : publishedDataSets(arguments.published)) asked.push_back(std::move(set));
  PairProvider provider(arguments.shared);
  std::vector<DataSet> sets;
  for (DataSet& set : asked) {
    const std::string reason = provider.unavailable(set);
    if (reason.empty()) {
      if (set.published) provider.make(set, arguments.first_seed);
      sets.push_back(std::move(set));
    } else {
      fmt::print(stderr, "skipped {}: {}\n", set.name, reason);
    }
  }
  if (sets.empty()) throw InputError("no data set is left to compare on");
  return sets;
}

CampaignOptions campaignOf(const Arguments& arguments) {
  CampaignOptions options;
  options.shared = arguments.shared;
  options.methods = arguments.methods;
  options.pairs = arguments.pairs;
  options.first_seed = arguments.first_seed;
  options.time_limit = arguments.time_limit;
  options.jobs = arguments.jobs;
  options.scratch = arguments.scratch.empty()
                        ? std::filesystem::path(arguments.output) / "scratch"
                        : std::filesystem::path(arguments.scratch) /
                              fmt::format("agricolmap_compare_{}", ::getpid());
  options.program = methodProgram();
  const std::vector<std::string> all = methodNamesOf(options.program);
  checkMethods(arguments.methods, all);
  if (options.methods.empty()) options.methods = all;
  for (const std::string& name : arguments.experiments) {
    for (Curve& curve : curvesOf(name, arguments.quick)) options.curves.push_back(std::move(curve));
  }
  options.datasets = chosenDataSets(arguments);
  return options;
}

void writeResult(const std::filesystem::path& path, const std::string& text) {
  io::StagedFile file(path, true);
  io::writeText(file.path(), text);
  file.commit();
}

/// Tables and page beside rows.csv, and with --docs the page of the repository.
void writePages(const Arguments& arguments) {
  const std::filesystem::path folder = arguments.output;
  std::string identity;
  const std::vector<Row> rows = withHeldAnswers(readRows(folder / "rows.csv", identity));
  writeResult(folder / "success_translation.csv", successCsv(rows, "translation"));
  writeResult(folder / "success_heading.csv", successCsv(rows, "heading"));
  writeResult(folder / "accuracy.csv", accuracyCsv(rows));
  writeResult(folder / "inliers.csv", inliersCsv(rows));
  writeResult(folder / "times.csv", timesCsv(rows));
  const Document document = comparisonDocument(rows, identity);
  const std::vector<Figure> figures = successFigures(rows);
  for (const Figure& figure : figures) writeResult(folder / figure.file_name, figure.svg);
  writeResult(folder / "comparison.html", toHtml(document));
  if (!arguments.docs.empty()) {
    const std::filesystem::path docs = arguments.docs;
    std::error_code error;
    std::filesystem::create_directories(docs / "images" / "comparison", error);
    if (error) throw OutputError(fmt::format("{}: {}", arguments.docs, error.message()));
    for (const Figure& figure : figures) {
      writeResult(docs / "images" / "comparison" / figure.file_name, figure.svg);
    }
    writeResult(docs / "comparison.md", toMarkdown(document, "images/comparison"));
  }
  fmt::print("{}\n\n{}\n", summarySentences(rows), (folder / "comparison.html").string());
}

void addFlags(CLI::App& app, Arguments& arguments) {
  app.add_option("-o,--output", arguments.output, "Folder for rows.csv, tables and page")
      ->required();
  app.add_option("--experiments", arguments.experiments,
                 fmt::format("{} [all]", fmt::join(experimentNames(), ", ")))
      ->delimiter(',');
  app.add_option("--methods", arguments.methods, "Names of `agricolmap_method list` [all]")
      ->delimiter(',');
  app.add_option("--datasets", arguments.datasets,
                 fmt::format("{} [all]", fmt::join(dataSetNames(), ", ")))
      ->delimiter(',');
  app.add_option("--dataset", arguments.published,
                 "Folder of real pairs as in docs/published-data.md, once or more; without\n"
                 "--datasets nothing else is compared on")
      ->allow_extra_args(false);
  app.add_option("--pairs", arguments.pairs,
                 "Pairs per data set; of a real one, wrong guesses for its pair [2; quick: 1]")
      ->check(CLI::Range(1, 100000));
  app.add_option("--first-seed", arguments.first_seed, "Seed of the first pair [80001]")
      ->check(CLI::Range(0, 1000000000));
  app.add_option("--settings", arguments.settings,
                 fmt::format("How pairs may differ: {}. Improve methods on the first only\n"
                             "[final; quick: develop]",
                             fmt::join(viewNames(), ", ")));
  app.add_option("--time-limit", arguments.time_limit,
                 "A run is ended after so much computing [60 s; quick: 8]")
      ->check(CLI::Range(0.5, 1e5));
  app.add_option("--jobs", arguments.jobs, "Runs at a time, each on one thread [1]")
      ->check(CLI::Range(1, 1024));
  app.add_option("--shared", arguments.shared, "Folder with the real data [../shared]");
  app.add_option("--scratch", arguments.scratch, "Folder for clouds in the meantime [--output]");
  app.add_option("--docs", arguments.docs,
                 "Write comparison.md and its pictures into this folder, too");
  app.add_flag("--quick", arguments.quick, "Small fields, few settings: minutes");
  app.add_flag("--page-only", arguments.page_only, "Only write tables and page from rows.csv");
  app.footer(
      "Seeds 31 and 51 to 53 served to tune the peers. An interrupted run goes on where it\n"
      "stopped when called again.");
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"The paper's experiments with the product and the methods it is compared with."};
  app.name("agricolmap_compare");
  addFlags(app, arguments);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }
  if (app.count("--datasets") == 0) {
    if (arguments.quick) arguments.datasets = {"sugar-beet-10m", "real-soybean"};
    if (!arguments.published.empty()) arguments.datasets.clear();
  }
  if (arguments.quick && app.count("--experiments") == 0)
    std::erase(arguments.experiments, "joint");
  if (arguments.pairs < 0) arguments.pairs = arguments.quick ? 1 : 2;
  if (arguments.settings.empty()) arguments.settings = arguments.quick ? "develop" : "final";
  arguments.views = parseViews(arguments.settings);
  if (arguments.time_limit < 0.0) arguments.time_limit = arguments.quick ? 8.0 : 60.0;
  installInterruptHandler();
  const std::filesystem::path folder = arguments.output;
  if (!arguments.page_only) {
    const CampaignOptions options = campaignOf(arguments);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
      throw OutputError(fmt::format("{}: cannot be made: {}", arguments.output, error.message()));
    }
    const ThreadLimit limit(arguments.jobs);
    RowTable table(folder / "rows.csv", identityOf(arguments, options.datasets));
    runCampaign(options, table);
  }
  writePages(arguments);
  return 0;
}

}  // namespace
}  // namespace agricolmap::experiments

int main(int argc, char** argv) {
  using agricolmap::ExitCode;
  const auto fail = [](const char* what, ExitCode code) {
    fmt::print(stderr, "agricolmap_compare: {}\n", what);
    return static_cast<int>(code);
  };
  spdlog::set_default_logger(spdlog::stderr_color_mt("agricolmap_compare"));
  spdlog::set_pattern("%^%l%$: %v");
  try {
    return agricolmap::compare::run(argc, argv);
  } catch (const agricolmap::Interrupted&) {
    return fail("interrupted; the same command goes on from here", ExitCode::kInterrupted);
  } catch (const agricolmap::Error& error) {
    return fail(error.what(), error.code());
  } catch (const std::exception& error) {
    return fail(error.what(), ExitCode::kInternal);
  }
}
