// agricolmap_method METHOD FIXED MOVING -o RESULT.json: one method on one pair, as a process of its
// own, whose memory and time can be measured and limited from outside.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <fstream>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "agricolmap/core/error.hpp"
#include "agricolmap/core/interrupt.hpp"
#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "agricolmap/io/text/text.hpp"
#include "experiments/methods/method.hpp"

namespace agricolmap::experiments {
namespace {

struct Arguments {
  double idle_memory = 0.0;  ///< before anything was done, libraries of all methods included [MiB]
  std::string method;
  std::string fixed;
  std::string moving;
  std::string guess;
  std::string prior_sigma;
  std::string truth;
  double inlier_tolerance = 0.1;
  double time_limit = 600.0;
  int threads = 0;
  bool overwrite = false;
  std::string output;
};

/// `T_M,HEADING_DEG,SCALE_PERCENT` or `none`, as for `agricolmap register`.
PriorUncertainty parsePrior(const std::string& text) {
  if (text.empty()) return {};
  if (text == "none") return PriorUncertainty::none();
  std::vector<double> numbers;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    const std::optional<double> number = io::parseNumber(rest.substr(0, comma));
    if (!number) numbers.clear();
    if (!number) break;
    numbers.push_back(*number);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (numbers.size() != 3) {
    throw UsageError(fmt::format(
        "--prior-sigma '{}': needs T_M,HEADING_DEG,SCALE_PERCENT such as 5,11.5,30, or none",
        text));
  }
  PriorUncertainty prior;
  prior.translation = numbers[0];
  prior.heading_deg = numbers[1];
  prior.scale = numbers[2] / 100.0;
  checkOptions(prior);
  return prior;
}

nlohmann::ordered_json matrixJson(const Eigen::Affine3d& transform) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int r = 0; r < 4; ++r) {
    nlohmann::ordered_json row = nlohmann::ordered_json::array();
    for (int c = 0; c < 4; ++c) row.push_back(transform.matrix()(r, c));
    rows.push_back(row);
  }
  return rows;
}

/// Matches whose fixed point lies horizontally within `tolerance` [m] of where the truth puts the
/// moving one.
std::size_t rightMatches(const MatchSet& matches, const Eigen::Affine3d& truth, double tolerance) {
  std::size_t right = 0;
  for (const MatchedPair& pair : matches.pairs) {
    if ((truth * pair.moving - pair.fixed).head<2>().norm() <= tolerance) ++right;
  }
  return right;
}

nlohmann::ordered_json matchesJson(const MatchSet& matches, const MethodInput& input,
                                   double tolerance) {
  nlohmann::ordered_json json = {{"count", matches.pairs.size()}, {"inliers", matches.inliers}};
  if (input.truth) {
    json["tolerance_m"] = tolerance;
    json["right"] = rightMatches(matches, *input.truth, tolerance);
  }
  return json;
}

/// Most memory that this program has held so far [MiB]. Not getrusage's figure: that starts from
/// what the process held that started this one.
double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  return 0.0;
}

std::string statusOf(const MethodOutcome& outcome) {
  if (!outcome.fixed_from_moving) return "failed";
  return outcome.accepted ? "accepted" : "not_accepted";
}

nlohmann::ordered_json resultJson(const Arguments& arguments, const MethodInput& input,
                                  const MethodOutcome& outcome, double read_s, double run_s) {
  nlohmann::ordered_json json;
  json["program"] = "agricolmap_method " AGRICOLMAP_VERSION;
  json["method"] = arguments.method;
  json["status"] = statusOf(outcome);
  json["why"] = outcome.why;
  json["fixed_from_moving"] =
      outcome.fixed_from_moving ? matrixJson(*outcome.fixed_from_moving) : nullptr;
  json["read_s"] = read_s;
  json["run_s"] = run_s;
  json["idle_memory_mib"] = arguments.idle_memory;
  json["peak_memory_mib"] = peakMemory();
  nlohmann::ordered_json stages = nlohmann::ordered_json::object();
  for (const auto& [stage, seconds] : outcome.times.stages()) stages[stage] = seconds;
  json["stages_s"] = stages;
  const double tolerance = arguments.inlier_tolerance;
  if (outcome.matches) json["matches"] = matchesJson(*outcome.matches, input, tolerance);
  if (outcome.rematches) json["rematches"] = matchesJson(*outcome.rematches, input, tolerance);
  return json;
}

ExitCode listMethods() {
  for (const std::string& name : methodNames()) {
    fmt::print("{:<24} {}\n", name, makeMethod(name)->about());
  }
  return ExitCode::kOk;
}

ExitCode runMethod(const Arguments& arguments) {
  const std::unique_ptr<Method> method = makeMethod(arguments.method);
  for (const auto& [value, what] : {std::pair{&arguments.fixed, "FIXED"},
                                    {&arguments.moving, "MOVING"},
                                    {&arguments.output, "-o RESULT.json"}}) {
    if (value->empty()) throw UsageError(fmt::format("{} is missing; see --help", what));
  }
  io::StagedFile output(arguments.output, arguments.overwrite);
  const ThreadLimit limit(arguments.threads);
  const PriorUncertainty prior = parsePrior(arguments.prior_sigma);
  const Stopwatch reading;
  const Cloud fixed = io::readCloud(arguments.fixed);
  const Cloud moving = io::readCloud(arguments.moving);
  const double read_s = reading.seconds();
  MethodInput input{.fixed = fixed, .moving = moving, .prior = prior};
  if (!arguments.guess.empty()) input.guess = io::readMatrix(arguments.guess);
  if (!arguments.truth.empty()) input.truth = io::readTransform(arguments.truth);
  input.time_limit = arguments.time_limit;
  const Stopwatch running;
  const MethodOutcome outcome = method->run(input);
  const double run_s = running.seconds();
  io::writeText(output.path(), resultJson(arguments, input, outcome, read_s, run_s).dump(2) + "\n");
  output.commit();
  return outcome.fixed_from_moving && outcome.accepted ? ExitCode::kOk : ExitCode::kRejected;
}

ExitCode run(int argc, char** argv) {
  Arguments arguments;
  arguments.idle_memory = peakMemory();
  CLI::App app{"Runs one registration method of the comparison on one pair of clouds."};
  app.name("agricolmap_method");
  app.footer(
      "`agricolmap_method list` says which methods there are. Exit codes: 0 the method stands by\n"
      "its transform; 10 it does not, or has none; 2 bad usage; 3 bad input; 4 output cannot be\n"
      "written. RESULT.json is written with 0 and 10 alike.");
  app.add_option("METHOD", arguments.method, "A method's name, or: list")->required();
  app.add_option("FIXED", arguments.fixed, "The drone's cloud, PLY or PCD");
  app.add_option("MOVING", arguments.moving, "The robot's cloud");
  app.add_option("--guess", arguments.guess,
                 "Initial guess, 4x4 text, moving -> fixed file coordinates [identity]");
  app.add_option("--prior-sigma", arguments.prior_sigma,
                 "How wrong it may be: T_M,HEADING_DEG,SCALE_PERCENT, or none [5,11.5,30]");
  app.add_option("--true-transform", arguments.truth,
                 "The truth: for the scales of oracle variants, and to count right matches");
  app.add_option("--inlier-tolerance", arguments.inlier_tolerance,
                 "A match this near to the truth is right [0.1 m, the vote's 5 cells]")
      ->check(CLI::Range(0.001, 10.0));
  app.add_option("--time-limit", arguments.time_limit,
                 "After which methods that improve step by step stop [600 s]")
      ->check(CLI::Range(0.1, 1e6));
  app.add_option("--threads", arguments.threads, "Number of threads, 0: all cores [0]")
      ->check(CLI::Range(0, 1024));
  app.add_flag("--overwrite", arguments.overwrite, "Replace a result that exists");
  app.add_option("-o,--output", arguments.output, "JSON file for the result");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::kOk : ExitCode::kUsage;
  }
  installInterruptHandler();
  return arguments.method == "list" ? listMethods() : runMethod(arguments);
}

}  // namespace
}  // namespace agricolmap::experiments

int main(int argc, char** argv) {
  using agricolmap::ExitCode;
  const auto fail = [](const char* what, ExitCode code) {
    fmt::print(stderr, "agricolmap_method: {}\n", what);
    return static_cast<int>(code);
  };
  try {
    return static_cast<int>(agricolmap::compare::run(argc, argv));
  } catch (const agricolmap::Error& error) {
    return fail(error.what(), error.code());
  } catch (const std::bad_alloc&) {
    return fail("out of memory", ExitCode::kInternal);
  } catch (const std::exception& error) {
    return fail(error.what(), ExitCode::kInternal);
  }
}
