#include "experiments/runner/register_one.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "agricolmap/core/parallel.hpp"
#include "agricolmap/io/cloud/cloud_reader.hpp"
#include "agricolmap/io/output/file_sink.hpp"
#include "agricolmap/io/output/staged_output.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "experiments/methods/method.hpp"
#include "experiments/runner/outcome_file.hpp"
#include "experiments/runner/run_pair.hpp"

namespace agricolmap::experiments {
namespace {

struct Arguments {
  std::string method;
  std::string fixed;
  std::string moving;
  std::string guess;
  PriorUncertainty told;
  std::string truth;
  double time_limit = 600.0;
  int threads = 0;
  bool overwrite = false;
  std::string output;
};

void registerOne(const Arguments& arguments, double idle_mib) {
  const Method method = makeMethod(arguments.method);
  io::StagedFile output(arguments.output, arguments.overwrite);
  const ThreadLimit limit(arguments.threads);
  const Stopwatch reading;
  const Cloud fixed = io::readCloud(arguments.fixed);
  const Cloud moving = io::readCloud(arguments.moving);
  Answer answer;
  answer.read_s = reading.seconds();
  answer.idle_mib = idle_mib;
  MethodInput input{.fixed = fixed,
                    .moving = moving,
                    .prior = arguments.told,
                    .time_limit = arguments.time_limit};
  checkOptions(input.prior);
  if (!arguments.guess.empty()) input.guess = io::readMatrix(arguments.guess);
  if (!arguments.truth.empty()) input.truth = io::readTransform(arguments.truth);
  const Stopwatch running;
  answer.outcome = method.run(input);
  answer.run_s = running.seconds();
  answer.peak_mib = peakMemory();
  io::writeText(output.path(), toJson(answer, arguments.method));
  output.commit();
}

}  // namespace

void addRegisterOne(CLI::App& app, double idle_mib, std::function<void()>& action) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* verb = app.add_subcommand("register-one", "Run one method on one pair of clouds");
  verb->add_option("METHOD", arguments->method, "One of `list methods`")->required();
  verb->add_option("FIXED", arguments->fixed, "The drone's cloud, PLY or PCD")->required();
  verb->add_option("MOVING", arguments->moving, "The robot's cloud")->required();
  verb->add_option("--guess", arguments->guess,
                   "Initial guess, 4x4 text, moving -> fixed file coordinates [identity]");
  verb->add_option("--prior-translation", arguments->told.translation,
                   fmt::format("How wrong it may be; {:g}: anywhere [5 m]", kAnywhere));
  verb->add_option("--prior-heading", arguments->told.heading_deg, "Likewise [11.5 deg]");
  verb->add_option("--prior-scale", arguments->told.scale, "Likewise, relative [0.3]");
  verb->add_flag("--scale-unknown", arguments->told.scale_unknown,
                 "The moving file's unit is unknown");
  verb->add_option("--true-transform", arguments->truth,
                   "The truth: for the scales of oracle variants, and to count right matches");
  verb->add_option("--time-limit", arguments->time_limit,
                   "After which methods that improve step by step stop [600 s]")
      ->check(CLI::Range(0.1, 1e6));
  verb->add_option("--threads", arguments->threads, "Number of threads, 0: all cores [0]")
      ->check(CLI::Range(0, 1024));
  verb->add_flag("--overwrite", arguments->overwrite, "Replace a result that exists");
  verb->add_option("-o,--output", arguments->output, "JSON file for the result")->required();
  verb->callback(
      [arguments, idle_mib, &action] { action = [=] { registerOne(*arguments, idle_mib); }; });
}

}  // namespace agricolmap::experiments
