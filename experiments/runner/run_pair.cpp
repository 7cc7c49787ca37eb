#include "experiments/runner/run_pair.hpp"

#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <utility>

#include "agricolmap/core/error.hpp"
#include "agricolmap/io/cloud/cloud_writer.hpp"
#include "agricolmap/io/text/matrix_file.hpp"
#include "experiments/runner/child_process.hpp"

namespace agricolmap::experiments {
namespace {

// The share of the time limit after which methods that can stop are asked to: the rest is for
// reading the clouds, which the limit covers, too.
constexpr double kSoftShare = 0.85;
const std::string kUnscaled = "0";

std::string firstLine(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

std::string stageText(const MethodTimes& times) {
  std::string text;
  for (const auto& [stage, seconds] : times.stages()) {
    text += fmt::format("{}{}={:.4f}", text.empty() ? "" : ";", stage, seconds);
  }
  return text;
}

/// Of all threads of this process so far [s].
double cpuSeconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void setErrors(const evaluate::RegistrationErrors& errors, Row& row) {
  row.rms = errors.rms;
  row.rms_horizontal = errors.rms_horizontal;
  row.rms_vertical = errors.rms_vertical;
  row.worst = errors.worst;
  row.rms_to_best_affine = errors.rms_to_best_affine;
  row.e_t = errors.translation;
  row.e_r = errors.rotation;
  row.e_s = errors.scale;
}

}  // namespace

PairRuns::PairRuns(Pair pair, int seed, RunOptions options, std::filesystem::path folder)
    : fixed_(std::move(pair.fixed)),
      guess_(pair.guess),
      overlaps_(pair.overlaps),
      seed_(seed),
      options_(std::move(options)),
      folder_(std::move(folder)) {
  Moving& unscaled = moving_[kUnscaled];
  unscaled.cloud = std::move(pair.moving);
  unscaled.truth = std::move(pair.truth);
  unscaled_ = &unscaled;
  if (options_.in_process) return;
  io::writePly(folder_ / "fixed.ply", *fixed_);
  writeFiles(kUnscaled, unscaled);
}

void PairRuns::writeFiles(const std::string& key, Moving& moving) const {
  moving.cloud_file = folder_ / fmt::format("moving_{}.ply", key);
  moving.truth_file = folder_ / fmt::format("truth_{}.txt", key);
  io::writePly(moving.cloud_file, moving.cloud);
  io::writeMatrix(moving.truth_file, moving.truth.best_affine, "truth, moving file -> fixed file");
}

const PairRuns::Moving& PairRuns::movingFor(const AddedError* error) {
  const std::lock_guard lock(mutex_);
  const std::string key = error == nullptr ? kUnscaled : fmt::format("{:.4g}", error->scale);
  const auto known = moving_.find(key);
  if (known != moving_.end()) return known->second;
  const Eigen::Affine3d scaled = scaleError(*error, seed_, unscaled_->cloud);
  Moving made = *unscaled_;
  transformCloud(made.cloud, scaled);
  made.truth.best_affine = unscaled_->truth.best_affine * scaled.inverse();
  if (!options_.in_process) writeFiles(key, made);
  return moving_.emplace(key, std::move(made)).first->second;
}

Eigen::Affine3d PairRuns::guessFor(const Start& start) const {
  if (start.error == nullptr) return guess_;
  // The guess takes the file's lengths at face value; the middle is where it was.
  return wrongGuess(start.suite, *start.error, seed_, unscaled_->cloud, guess_);
}

void PairRuns::run(const Method& method, const Start& start, const std::string& name, Row& row) {
  const Moving& moving = movingFor(start.error);
  row.in_process = options_.in_process;
  row.negative = !overlaps_;
  row.fixed_points = static_cast<double>(fixed_->size());
  row.moving_points = static_cast<double>(moving.cloud.size());
  if (options_.in_process) {
    fillErrors(runHere(method, moving, start, row), moving, row);
  } else if (const auto outcome = runChildOf(method, moving, start, name, row)) {
    fillErrors(*outcome, moving, row);
  }
}

MethodOutcome PairRuns::runHere(const Method& method, const Moving& moving, const Start& start,
                                Row& row) const {
  const MethodInput input{.fixed = *fixed_,
                          .moving = moving.cloud,
                          .guess = guessFor(start),
                          .prior = start.told,
                          .truth = moving.truth.best_affine};
  const Stopwatch watch;
  const double cpu = cpuSeconds();
  MethodOutcome outcome = method.run(input);
  row.run_s = row.wall_s = watch.seconds();
  row.cpu_s = cpuSeconds() - cpu;
  return outcome;
}

std::optional<MethodOutcome> PairRuns::runChildOf(const Method& method, const Moving& moving,
                                                  const Start& start, const std::string& name,
                                                  Row& row) const {
  const std::filesystem::path guess = folder_ / (name + ".guess.txt");
  const std::filesystem::path result = folder_ / (name + ".json");
  const std::filesystem::path log = folder_ / (name + ".log");
  io::writeMatrix(guess, guessFor(start), "initial guess, moving file -> fixed file");
  std::vector<std::string> command = {options_.program.string(), "register-one", method.name,
                                      (folder_ / "fixed.ply").string(), moving.cloud_file.string()};
  const auto give = [&](const std::string& flag, const std::string& value) {
    command.insert(command.end(), {flag, value});
  };
  give("--guess", guess.string());
  give("--true-transform", moving.truth_file.string());
  give("--prior-translation", fmt::format("{}", start.told.translation));
  give("--prior-heading", fmt::format("{}", start.told.heading_deg));
  give("--prior-scale", fmt::format("{}", start.told.scale));
  if (start.told.scale_unknown) command.emplace_back("--scale-unknown");
  give("--time-limit", fmt::format("{:.3f}", kSoftShare * options_.time_limit));
  give("--threads", fmt::format("{}", options_.threads));
  give("--output", result.string());
  const ChildResult child = runChild(command, options_.time_limit, log);
  row.wall_s = child.wall_s;
  row.cpu_s = child.cpu_s;
  std::optional<MethodOutcome> outcome;
  if (child.timed_out) {
    row.status = "timeout";
    row.peak_mib = child.peak_mib;
    row.message = fmt::format("ended after {:.0f} s", options_.time_limit);
  } else if (child.exit_code == 0) {
    Answer answer = readAnswer(result);
    row.run_s = answer.run_s;
    row.peak_mib = answer.peak_mib;
    row.idle_mib = answer.idle_mib;
    outcome = std::move(answer.outcome);
  } else if (child.exit_code > 1) {
    // Bad usage or input is a fault of the experiment, not of the method.
    throw InputError(fmt::format("register-one {}: {}", method.name, firstLine(log)));
  } else {
    row.status = "crashed";
    row.message = child.signal != 0 ? fmt::format("signal {}", child.signal) : firstLine(log);
  }
  for (const std::filesystem::path& path : {guess, result, log}) {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
  return outcome;
}

void PairRuns::fillErrors(const MethodOutcome& outcome, const Moving& moving, Row& row) const {
  row.status = statusOf(outcome);
  row.accepted = row.status == "accepted";
  row.message = outcome.why;
  row.stages = stageText(outcome.times);
  for (const auto& [name, value] : outcome.facts) row.*numberColumn(name) = value;
  if (!outcome.fixed_from_moving) return;
  const evaluate::RegistrationErrors errors =
      evaluate::evaluateTransform(*outcome.fixed_from_moving, moving.truth, moving.cloud);
  setErrors(errors, row);
  const evaluate::SuccessLimits limits;
  row.right = overlaps_ && errors.within(limits);
  row.right_in_plane = overlaps_ && errors.rms_horizontal <= limits.rms;
  if (!outcome.stated) return;
  if (const auto coverage = coverageOf(*outcome.fixed_from_moving, *outcome.stated, *fixed_,
                                       moving.cloud, moving.truth)) {
    row.pose_mahalanobis2 = coverage->pose_distance2;
    row.centre_mahalanobis2 = coverage->shift_distance2;
    row.height_mahalanobis2 = coverage->height_distance2;
  }
}

double peakMemory() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kib = 0.0;
    if (word == "VmHWM:" && status >> kib) return kib / 1024.0;
  }
  return 0.0;
}

}  // namespace agricolmap::experiments
