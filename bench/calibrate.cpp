// agricolmap_calibrate: fits the probability of being right to the rows of campaigns.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <utility>
#include <vector>

#include "../apps/agricolmap/exit_code.hpp"
#include "agricolmap/core/error.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "calibration.hpp"

namespace agricolmap::campaign {
namespace {

struct Arguments {
  std::vector<std::string> inputs;
  std::vector<std::string> tests;
  std::string output;
  std::string preset = "default";
  double ridge = 1.0;
  double margin = 0.5;
  int folds = 5;
  bool plane = false;
};

/// The rows of all files, and where they come from.
std::vector<PairRow> readAll(const std::vector<std::string>& paths, const char* purpose,
                             std::string& origin) {
  std::vector<PairRow> rows;
  for (const std::string& path : paths) {
    std::string identity;
    std::vector<PairRow> more = readPairs(path, identity);
    rows.insert(rows.end(), more.begin(), more.end());
    origin += fmt::format("{} {} ({} rows): {}\n", purpose, path, more.size(), identity);
  }
  return rows;
}

void addSet(Calibration& calibration, const std::string& name,
            const std::vector<Statement>& statements) {
  calibration.qualities[name] = qualityOf(statements);
  calibration.counts[name] = countAt(statements, calibration.threshold.probability);
}

Calibration calibrate(const Arguments& arguments) {
  Calibration made;
  const RightAbout about = arguments.plane ? RightAbout::kPlane : RightAbout::kAll;
  const CalibrationSamples samples =
      samplesOf(readAll(arguments.inputs, "fitted to", made.origin), arguments.preset, about);
  made.without_answer = samples.without_answer;
  made.solvable_without = samples.solvable_without;
  made.model = fitLogistic(samples.features, samples.right, arguments.ridge, featureSigns());
  const std::vector<Statement> unseen = crossValidate(samples, arguments.folds, arguments.ridge);
  made.threshold = chooseThreshold(unseen, arguments.margin);
  addSet(made, "fit", statementsOf(samples, made.model));
  addSet(made, "cross-validation", unseen);
  if (!arguments.tests.empty()) {
    const CalibrationSamples test =
        samplesOf(readAll(arguments.tests, "tested on", made.origin), arguments.preset, about);
    addSet(made, "test", statementsOf(test, made.model));
  }
  return made;
}

int run(int argc, char** argv) {
  Arguments arguments;
  CLI::App app{"Fits the probability that a registration is right to the rows of campaigns."};
  app.name("agricolmap_calibrate");
  app.add_option("PAIRS", arguments.inputs, "pairs.csv of campaigns")->required();
  app.add_option("--test", arguments.tests, "pairs.csv of campaigns to test on");
  app.add_option("-o,--output", arguments.output, "Folder for calibration.json and reliability.csv")
      ->required();
  app.add_option("--preset", arguments.preset, "Rows of this preset [default]");
  app.add_option("--ridge", arguments.ridge, "Penalty on standardised weights [1]")
      ->check(CLI::Range(1e-9, 1e6));
  app.add_option("--margin", arguments.margin,
                 "Logit between the highest wrong answer and the threshold [0.5]")
      ->check(CLI::Range(0.0, 20.0));
  app.add_option("--folds", arguments.folds, "Parts that the fields are split into [5]")
      ->check(CLI::Range(2, 100));
  app.add_flag("--plane", arguments.plane, "Right means the horizontal RMS, without the heights");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }
  const Calibration made = calibrate(arguments);
  std::error_code error;
  std::filesystem::create_directories(arguments.output, error);
  if (error) {
    throw OutputError(fmt::format("{}: cannot be made: {}", arguments.output, error.message()));
  }
  const std::filesystem::path folder = arguments.output;
  for (const auto& [name, text] :
       {std::pair<const char*, std::string>{"calibration.json", calibrationJson(made)},
        {"reliability.csv", reliabilityCsv(made)}}) {
    io::StagedFile file(folder / name, true);
    io::writeText(file.path(), text);
    file.commit();
  }
  fmt::print("{}", calibrationText(made));
  return 0;
}

}  // namespace
}  // namespace agricolmap::campaign

int main(int argc, char** argv) {
  try {
    return agricolmap::campaign::run(argc, argv);
  } catch (const agricolmap::Error& error) {
    fmt::print(stderr, "agricolmap_calibrate: {}\n", error.what());
    return static_cast<int>(agricolmap::exitCodeOf(error.kind()));
  } catch (const std::exception& error) {
    fmt::print(stderr, "agricolmap_calibrate: {}\n", error.what());
    return static_cast<int>(agricolmap::ExitCode::kInternal);
  }
}
